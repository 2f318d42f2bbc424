"""Surface of the terrain: orthophotos, land use and building footprints."""
