"""Satellite imagers: simulated pixels of a run, without Blender.

None of these imagers observed the King Fire of 2014 like this: GOES-18 was launched in 2022. The pictures are
hypothetical and are labelled so in their metadata.
"""
