"""Writer of 3D Tiles from a run's elevation, an orthophoto and building footprints."""
