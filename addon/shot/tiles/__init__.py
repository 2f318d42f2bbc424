"""3D tiles of a shot: the prepared selection, its terms of use, and vegetation on tiles."""
