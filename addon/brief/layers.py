"""Map layers as PNG pictures in Web Mercator: hill shading, fuel and arrival time."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from firetwin_core.run import Run
from matplotlib.colors import LightSource, to_hex
from numpy.typing import NDArray
from PIL import Image

from ..run import areas, thumbnails, times
from ..run.measure import Units
from . import mercator, units
from .mercator import Box

LONGEST = 1100  # maximum length of the longer side, pixels
_LEAST = 600  # pixels, for smooth hill shading of coarse grids
_LEVELS = 24  # colours of a ramp
_GREYS = 48  # levels of the hill shading
_BEFORE = "#6b6560"  # burned before the start of the run
_ARRIVAL = [to_hex(c) for c in matplotlib.colormaps["plasma"](np.linspace(0.05, 0.97, _LEVELS))]
ARRIVAL_PALETTE = ("#000000", _BEFORE, *_ARRIVAL)
"""Colours of `arrival_index`; the first is transparent."""
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


@dataclass(frozen=True)
class Legend:
    """Colour ramp from low to high, tick labels at positions from 0 to 1, and separately labelled colours."""

    title: str
    colours: tuple[str, ...]
    ticks: tuple[tuple[float, str], ...]
    notes: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Layer:
    """Picture of a map box; `legend` is None for hill shading.

    Attributes
    ----------
    opacity
        Initial opacity, from 0 to 1.
    shown
        True if the layer is initially visible.
    """

    name: str
    title: str
    box: Box
    png: bytes
    legend: Legend | None
    opacity: float
    shown: bool


def draw(run: Run, elevation: NDArray[np.floating], zone: str, order: Units = "us") -> list[Layer]:
    """Draw all layers of a run, lowest first.

    Parameters
    ----------
    elevation
        (fy, fx) on the fuel grid, m; can come from a user's elevation model.
    zone
        Time zone of the legend.
    order
        Units of the legend.
    """
    return [_hillshade(run, elevation), _fuel(run, order), _arrival(run, zone)]


def _hillshade(run: Run, elevation: NDArray[np.floating]) -> Layer:
    """Draw hill shading with light from the north-west."""
    grey = np.round((0.35 + 0.63 * shade(run, elevation)) * (_GREYS - 1)) / (_GREYS - 1)
    box, pixels = _sampled(run, np.round(255.0 * grey).astype(np.uint8), _LEAST)
    return Layer("hillshade", "Terrain (hill shading)", box, _png(Image.fromarray(pixels)), None, 1.0, True)


def shade(run: Run, elevation: NDArray[np.floating]) -> NDArray[np.float64]:
    """Compute hill shading (fy, fx) from 0 to 1, lit from the north-west."""
    known = elevation[np.isfinite(elevation)]
    height = np.nan_to_num(elevation.astype(np.float64), nan=float(known.min()) if known.size else 0.0)
    latitude, longitude = np.argsort(-run.fuel_latitude), np.argsort(run.fuel_longitude)
    if min(height.shape) < 3:
        return np.full(height.shape, 0.7)
    dx, dy = areas.spacing(run.fuel_latitude, run.fuel_longitude)
    lit = LightSource(azdeg=315, altdeg=45)
    shaded = np.empty(height.shape)
    facing_north = height[np.ix_(latitude, longitude)]
    shaded[np.ix_(latitude, longitude)] = lit.hillshade(facing_north, vert_exag=2.0, dx=dx, dy=dy)
    return shaded


def _fuel(run: Run, order: Units) -> Layer:
    """Draw the sum of surface and canopy fuel; transparent without fuel."""
    unit = units.FUEL[order]
    fuel = (np.nan_to_num(run.surface_fuel) + np.nan_to_num(run.canopy_fuel)) * unit.factor
    burnable = fuel[fuel > 0.0]
    high = _round_up(float(np.percentile(burnable, 99.5))) if burnable.size else 1.0
    index = np.where(fuel > 0.0, 1 + np.minimum(fuel / high * _LEVELS, _LEVELS - 1), 0).astype(np.uint8)
    ramp = thumbnails.coloured(np.linspace(0.0, 1.0, _LEVELS), thumbnails.FUEL)
    colours = tuple(to_hex(colour) for colour in ramp.reshape(-1, 3))
    box, pixels = _sampled(run, index)
    ticks = [(share, f"{share * high:g}") for share in (0.0, 0.25, 0.5)]
    legend = Legend(f"Fuel load, {unit.name}", colours, (*ticks, (1.0, f"≥ {high:g}")))
    return Layer("fuel", "Fuel load", box, _indexed(pixels, ["#000000", *colours]), legend, 0.75, False)


def _arrival(run: Run, zone: str) -> Layer:
    """Draw the arrival time at each fuel cell; transparent where the fire does not arrive."""
    first, last = float(run.times[0]), float(run.times[-1])
    index = arrival_index(run)
    box, pixels = _sampled(run, index)
    ticks = tuple((at, _clock(run, first + at * (last - first), zone)) for at in (0.0, 0.5, 1.0))
    notes = ((_BEFORE, "burned before the run"),) if (index == 1).any() else ()
    legend = Legend(f"Fire arrival, {_zone_name(run, zone)}", tuple(_ARRIVAL), ticks, notes)
    return Layer("arrival", "Fire arrival time", box, _indexed(pixels, ARRIVAL_PALETTE), legend, 0.8, True)


def arrival_index(run: Run) -> NDArray[np.uint8]:
    """Compute the index into `ARRIVAL_PALETTE` of each fuel cell (fy, fx); 0 without fire."""
    arrival = np.asarray(run.fuel_arrival_time(), np.float64)
    first, last = float(run.times[0]), float(run.times[-1])
    share = np.clip(np.nan_to_num((arrival - first) / max(last - first, 1.0)), 0.0, 1.0)
    index = (2 + np.minimum(share * _LEVELS, _LEVELS - 1)).astype(np.uint8)
    with np.errstate(invalid="ignore"):
        index[arrival < first] = 1
        index[~(arrival <= last)] = 0
    return index


def _sampled(run: Run, values: NDArray[np.uint8], least: int = 0) -> tuple[Box, NDArray[np.uint8]]:
    """Resample fuel cells (fy, fx) to Web Mercator pixels, starting in the north-west."""
    latitude, longitude = run.fuel_latitude, run.fuel_longitude
    box = Box.of_grid(run, latitude, longitude)
    columns, rows = box.size(min(max(*values.shape, least), LONGEST))
    row, column = mercator.cells(latitude, box.rows(rows)), mercator.cells(longitude, box.columns(columns))
    return box, values[np.ix_(row, column)]


def _indexed(pixels: NDArray[np.uint8], colours: Sequence[str]) -> bytes:
    """Encode a PNG with a palette, whose first colour is transparent."""
    picture = Image.fromarray(pixels)
    picture.putpalette([int(colour[i : i + 2], 16) for colour in colours for i in (1, 3, 5)])
    return _png(picture, transparency=0)


def _png(picture: Image.Image, **options: int) -> bytes:
    data = io.BytesIO()
    picture.save(data, "PNG", optimize=True, **options)
    return data.getvalue()


def _round_up(value: float) -> float:
    """Round up to 1, 2, 2.5 or 5 times a power of ten."""
    unit = 10.0 ** np.floor(np.log10(value))
    return float(next(step * unit for step in _STEPS if step * unit >= value * (1.0 - 1e-9)))


def _clock(run: Run, time: float, zone: str) -> str:
    """Format day and hour of a model time (s)."""
    return (
        times.text(times.utc(run, time), zone).rpartition(" ")[0].replace(f" {times.utc(run, time):%Y} ", " ")
    )


def _zone_name(run: Run, zone: str) -> str:
    return times.text(times.utc(run, float(run.times[0])), zone).rpartition(" ")[2]
