"""Cameras for a run without a scene file: one sees the fire from its windward side, one from above."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from ..run import areas
from .rigs._key import CameraKey
from .rigs.drone import Drone
from .rigs.satellite import Satellite
from .settings import Camera

_DISTANCE = 1.1  # from the fire's middle, in lengths of the burned area
_HEIGHT = 0.3  # above the ground, in the same lengths
_LEAST = 4000.0  # m, the length of a fire that has burned little or nothing
_SOUTH_WEST = np.array([1.0, 1.0]) / np.sqrt(2.0)  # direction of a wind that nobody measured


def cameras(run: Run) -> tuple[Camera, ...]:
    """A drone that looks at the fire and stays, and a satellite that sees the whole run."""
    latitude, longitude = np.asarray(run.latitude), np.asarray(run.longitude)
    (west, south), (east, north) = burned(run)
    middle = np.array([(west + east) / 2, (south + north) / 2])
    one_degree = np.array(areas.spacing(middle[1] + [-0.5, 0.5], middle[0] + [-0.5, 0.5]))  # m east, north
    length = max(float(np.hypot(*((east - west, north - south) * one_degree))), _LEAST)
    width, height = np.array([np.ptp(longitude), np.ptp(latitude)]) * one_degree
    swath = max(width, height * 16 / 9, _LEAST) * 1.05
    place = middle - _DISTANCE * length * blowing(run) / one_degree
    key = CameraKey(0.0, float(place[1]), float(place[0]), _HEIGHT * length, "point", *middle[::-1].tolist())
    return (
        Camera("overview", rig=Drone(keys=(key,))),
        Camera("satellite", rig=Satellite(swath=float(swath))),
    )


def burned(run: Run) -> tuple[tuple[float, float], tuple[float, float]]:
    """Longitude and latitude of the corners of what burns in the run; of all of it where nothing does."""
    arrival = np.asarray(run.fuel_arrival_time())
    rows, columns = np.nonzero(np.isfinite(arrival))
    latitude, longitude = np.asarray(run.fuel_latitude), np.asarray(run.fuel_longitude)
    if len(rows):
        latitude, longitude = latitude[rows], longitude[columns]
    return (
        (float(longitude.min()), float(latitude.min())),
        (float(longitude.max()), float(latitude.max())),
    )


def blowing(run: Run) -> np.ndarray:
    """Unit vector (east, north) that the wind of the middle of the run blows to; north-east without wind."""
    if not {"wind_east", "wind_north"} <= set(run.fields):
        return _SOUTH_WEST
    mean = np.array([np.nanmean(part) for part in run.wind(len(run.times) // 2)])
    speed = float(np.hypot(*mean))
    return mean / speed if np.isfinite(speed) and speed > 0.1 else _SOUTH_WEST
