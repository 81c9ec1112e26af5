"""One file a verb: its arguments, one call of the library, what is printed, and the exit code."""
