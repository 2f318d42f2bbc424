"""Shared parts of fire model readers: georeferenced grids, rasters, fuels, heat flux, and the run writer."""
