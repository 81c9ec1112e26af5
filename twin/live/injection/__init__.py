"""Faults made on purpose: in a channel, in a log, on a bus, in a process."""
