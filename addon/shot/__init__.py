"""Shots: settings and run, resolved once: cameras, passes, terrain, fire and light."""
