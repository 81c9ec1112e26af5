"""The voyage on an even grid: smooth motion, segments, and whether there is a sea."""
