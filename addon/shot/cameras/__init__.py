"""Cameras without Blender: paths, lenses, rotations, recorded tracks; `rigs` has one file for each kind."""
