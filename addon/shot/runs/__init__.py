"""Runs of a scene file: opened and checked against the time window and the settings."""
