"""Materials of the ground and the trees."""
