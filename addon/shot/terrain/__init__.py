"""Terrain: elevation, fuels, land use, the apron, and mesh accuracy."""
