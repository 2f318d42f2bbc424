"""Camera models without Blender: paths, lenses, rotations, recorded tracks. `rigs` has one file per kind."""
