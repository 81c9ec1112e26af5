"""Open-loop runs: errors by horizon and channel beside what was expected, and where the model fails."""
