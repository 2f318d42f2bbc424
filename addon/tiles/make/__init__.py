"""Makes 3-D Tiles of a run's elevation, an orthophoto and building footprints."""
