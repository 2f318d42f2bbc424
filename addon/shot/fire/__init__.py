"""Fire of a shot: fuel, fronts, heat release, flame depth and emissions, computed once."""
