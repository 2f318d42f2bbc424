"""Geometry: positions on the Earth, map projections, grids, polygons and rotations."""
