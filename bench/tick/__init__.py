"""The budget of one tick: time, memory, instructions, and peers in the same run."""
