"""Scenes: Blender data of a shot's terrain, forest, fire, smoke, light, cameras, labels and tiles."""
