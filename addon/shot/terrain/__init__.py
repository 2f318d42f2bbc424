"""Terrain: elevation, fuels, the apron, and mesh accuracy."""
