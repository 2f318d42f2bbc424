"""Jobs on 3D Tiles and imagery of servers: fetch, decode, select, write, list."""
