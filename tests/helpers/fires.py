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


def write_run(make_run, arrival, cells=120, cell=50.0, coarse=24, count=9, interval=600.0, **fields):
    """Write a run without air on `cells` x `cells` of a size (m), with arrival times (s) or None."""
    latitude, longitude = axes(cells, cell)
    rows, columns = axes(coarse, 250.0)
    fuel, flux = np.ones((cells, cells), np.float32), np.zeros((count, coarse, coarse), np.float32)
    defaults = {
        **{"latitude": rows, "longitude": columns, "fuel_latitude": latitude, "fuel_longitude": longitude},
        **{"elevation": flux[0], "surface_fuel": fuel, "canopy_fuel": fuel, "heat_flux": flux},
        **dict.fromkeys(("temperature", "wind_east", "wind_north")),
        "fuel_arrival_time": None if arrival is None else arrival.astype(np.float32),
    }
    toml = f'start = 2014-09-17T04:45:00Z\ninterval_s = {interval}\nvertical = "orthometric"\n'
    return make_run(toml='name = "Round"\n' + toml, **(defaults | fields))


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
