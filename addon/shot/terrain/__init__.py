"""The terrain as a function: elevation, fuels, land use, the apron, and how finely it is drawn."""
