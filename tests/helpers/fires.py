"""Circular fires on small grids, and files of their observations, for tests of scores."""

import json
from pathlib import Path

import numpy as np
from firetwin.run import areas

LATITUDE, LONGITUDE = 38.9, -120.6
NORTH, EAST = areas.metres_per_degree(LATITUDE)


def axes(n=120, cell=50.0):
    """Centres (n,) of square cells about the place, degrees north and east."""
    metres = (np.arange(n) - (n - 1) / 2) * cell
    return LATITUDE + metres / NORTH, LONGITUDE + metres / EAST


def round_fire(latitude, longitude, speed=0.5, east=0.0, north=0.0):
    """Arrival times (s) of a fire that spreads as a circle from a point (m from the place)."""
    x = (longitude - LONGITUDE) * EAST - east
    y = (latitude - LATITUDE) * NORTH - north
    return np.hypot(*np.meshgrid(x, y)) / speed


def circle(radius, east=0.0, north=0.0, corners=360):
    """Ring (n, 2) in degrees of a circle in metres about the place."""
    turn = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    return degrees(east + radius * np.cos(turn), north + radius * np.sin(turn))


def square(side, east=0.0, north=0.0):
    """Ring of a square with a corner at a point."""
    return degrees(np.array([0, side, side, 0]) + east, np.array([0, 0, side, side]) + north)


def degrees(east, north):
    return np.column_stack([LONGITUDE + np.asarray(east) / EAST, LATITUDE + np.asarray(north) / NORTH])


def closed(ring):
    return [*ring.tolist(), ring[0].tolist()]


def geojson(path: Path, *features, **members):
    """Write (rings, properties) as a FeatureCollection."""
    rows = [
        {
            "type": "Feature",
            "properties": properties,
            "geometry": {"type": "Polygon", "coordinates": [closed(ring) for ring in rings]},
        }
        for rings, properties in features
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": rows} | members))
    return path
