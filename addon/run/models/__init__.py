"""What all readers of fire models' files share: grids on the Earth, rasters, fuels, heat, and the writer."""
