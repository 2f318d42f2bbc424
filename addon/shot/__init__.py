"""Shots: what is filmed, resolved once from settings and run: cameras, passes, terrain, fire, light."""
