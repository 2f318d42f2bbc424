"""Pixels of satellites' imagers, worked out from a run without Blender.

None of these imagers saw the King Fire of 2014 so: GOES-18 was launched in 2022. Their pictures are
hypothetical, and say so in their metadata.
"""
