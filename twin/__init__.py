"""A digital twin of a ship's motion that runs on board in real time and that its owner can correct."""
