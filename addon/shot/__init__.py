"""Shots: settings, scene files, cameras, passes, terrain, fire and light. Needs no Blender."""
