"""The whole service, everything on: killed, paused, its clock set, and lied to."""
