"""Facts about the King Fire, the synthetic sample run, and the library of solved flames."""
