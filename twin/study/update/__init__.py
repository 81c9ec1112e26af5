"""Add an effect and prove the fall, take it out again, and the history of both."""
