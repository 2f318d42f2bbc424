"""Pictures of a run's grid in degrees: arrival of the fire, and fuel, with their bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..run import areas, thumbnails

LONGEST = 2048
"""Maximum length of the longer side, pixels."""
ARRIVAL = ("#0d0887", "#5c01a6", "#9c179e", "#cc4778", "#ed7953", "#fdb42f", "#f0f921")
"""Colours of arrival times from early to late: matplotlib's colour map "plasma"."""
_BEFORE = (107, 101, 96)  # burned before the start of the run


@dataclass(frozen=True)
class Overlay:
    """Picture (h, w, 4) of sRGB and alpha, north up, with its bounds in degrees."""

    title: str
    pixels: NDArray[np.uint8]
    west: float
    south: float
    east: float
    north: float


def draw(run: Run) -> list[Overlay]:
    """Draw the arrival of the fire and the fuel load."""
    return [_make(run, "Fire arrival", _arrival(run)), _make(run, "Fuel load", _fuel(run))]


def _arrival(run: Run) -> NDArray[np.uint8]:
    arrival = np.asarray(run.fuel_arrival_time(), np.float64)
    first, last = float(run.times[0]), float(run.times[-1])
    share = np.clip(np.nan_to_num((arrival - first) / max(last - first, 1.0)), 0.0, 1.0)
    colour = np.round(255.0 * thumbnails.coloured(share, ARRIVAL)).astype(np.uint8)
    with np.errstate(invalid="ignore"):
        colour[arrival < first] = _BEFORE
        burned = arrival <= last
    return np.dstack([colour, np.where(burned, 255, 0).astype(np.uint8)])


def _fuel(run: Run) -> NDArray[np.uint8]:
    fuel = np.nan_to_num(run.surface_fuel) + np.nan_to_num(run.canopy_fuel)
    burnable = fuel[fuel > 0.0]
    high = float(np.percentile(burnable, 99.5)) if burnable.size else 1.0
    colour = np.round(255.0 * thumbnails.coloured(np.clip(fuel / high, 0.0, 1.0), thumbnails.FUEL))
    return np.dstack([colour.astype(np.uint8), np.where(fuel > 0.0, 255, 0).astype(np.uint8)])


def _make(run: Run, title: str, cells: NDArray[np.uint8]) -> Overlay:
    """Sample fuel cells (fy, fx, 4) on even steps of degrees; the nearest cell counts."""
    latitude, longitude = run.fuel_latitude, run.fuel_longitude
    (south, north), (west, east) = (
        (float(found.min()), float(found.max())) for found in map(areas.edges, (latitude, longitude))
    )
    rows, columns = (min(length, LONGEST) for length in cells.shape[:2])
    down = north - (np.arange(rows) + 0.5) / rows * (north - south)
    across = west + (np.arange(columns) + 0.5) / columns * (east - west)
    row, column = nearest(latitude, down), nearest(longitude, across)
    return Overlay(title, cells[np.ix_(row, column)], west, south, east, north)


def nearest(axis: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the index of the cell of an ascending or descending axis at each wanted value."""
    order = np.argsort(axis)
    bounds = areas.edges(axis[order])
    return order[np.clip(np.searchsorted(bounds, wanted, "right") - 1, 0, len(axis) - 1)]
