"""Briefing page: one HTML file of a run with map, fronts by time, stations, pictures, scores and sources.

The page needs no network, as scripts, styles, pictures and clips are in the file (see `page`).
"""
