"""Forecasts: ensembles of simulated members of one fire, their readers, scores, passes and lists."""
