"""3D Tiles: tilesets of folders, archives and servers, and the selection of tiles for a shot."""
