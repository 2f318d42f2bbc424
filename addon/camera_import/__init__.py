"""Imported cameras: moves of other programs as cameras of a scene file."""
