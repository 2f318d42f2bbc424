"""3D Tiles: tilesets of folders, archives and servers, and the choice of tiles for a shot."""
