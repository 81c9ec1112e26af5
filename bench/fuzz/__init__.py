"""Coverage-guided fuzzing of what reads the outside world."""
