"""Exports: a scene in formats of other programs, placed on the Earth."""
