"""3D tiles in the scene: meshes of the selected tiles, and their pictures."""
