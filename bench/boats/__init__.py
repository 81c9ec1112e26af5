"""Calibration and diagnosis of vessels with several actuators, on the boats of the reference sea."""
