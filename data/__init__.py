"""Facts about the King Fire, and the synthetic sample run."""
