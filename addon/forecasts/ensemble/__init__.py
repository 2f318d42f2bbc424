"""Ensembles: the arrival times of many simulated members of one fire, and statistics of them."""
