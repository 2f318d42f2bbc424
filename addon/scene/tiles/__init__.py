"""3-D Tiles in the scene: meshes of the chosen tiles, and their pictures."""
