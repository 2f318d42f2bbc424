"""Passes: each module declares one and finishes its files (see `shot.passes`); helpers begin with "_"."""
