"""What burns in a shot: fuel, fronts, heat release, flame depth, emissions; gathered once."""
