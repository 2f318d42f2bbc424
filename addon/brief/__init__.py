"""Briefing page: one HTML file of a run, with a map, fronts by time, places, pictures, scores and sources.

The page needs no network: scripts, styles, pictures and clips are in the file (see `page`).
"""
