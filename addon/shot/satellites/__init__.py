"""Satellite imagers: simulated pixels of a run, without Blender.

The pictures are simulated, not observed, and their metadata labels them as hypothetical. ABI was not yet in
orbit in September 2014 (GOES-16 was launched in 2016). VIIRS was, but its observations are not used here.
"""
