"""Picture under the lines of the map sheet: hill shading and arrival times in the projection of the sheet."""

from __future__ import annotations

import io

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from PIL import Image

from ..run import areas
from . import layers
from .map_frame import MapFrame

OPACITY = 0.62
"""Opacity of arrival times over the hill shading."""
_LIGHTEST, _RANGE = 0.99, 0.32  # grey of the hill shading: light, so that lines and texts are legible
_DOTS = 8.0  # pixels per mm, 200 dpi
_MOST, _LEAST = 2400, 300  # columns
_CHECKED = 200  # columns of the check for areas outside the run
_PER_CELL = 3  # most pixels across a fuel cell
_QUALITY = 85  # of the JPEG
OUTSIDE, OUTSIDE_LINE = "#ffffff", "#c4c4c4"
"""Colours of the hatching beyond the grid of the run."""
_HATCH = 2.5  # mm between lines of the hatching

Array = NDArray[np.float64]


def picture(run: Run, elevation: NDArray[np.floating], frame: MapFrame) -> bytes:
    """Draw the frame as a JPEG, with pixels of 1/200 in, or larger on large sheets.

    Parameters
    ----------
    elevation
        (fy, fx) on the fuel grid, m.
    """
    columns = min(round(frame.width * _DOTS), _MOST, max(_LEAST, _PER_CELL * _cells(run, frame)))
    row, column, inside = _locate(run, *frame.pixels(columns))
    row, column = (
        np.clip(at, 0.0, size - 1.0) for at, size in zip((row, column), elevation.shape, strict=True)
    )
    shade = bilinear(layers.shade(run, elevation), row, column)
    index = layers.arrival_index(run)[np.rint(row).astype(np.int64), np.rint(column).astype(np.int64)]
    pixels = _colours()[index, np.rint(255.0 * shade.clip(0.0, 1.0)).astype(np.uint8)]
    if not inside.all():
        pixels[~inside] = _hatching(inside.shape, columns / frame.width)[~inside]
    data = io.BytesIO()
    Image.fromarray(pixels).save(data, "JPEG", quality=_QUALITY)
    return data.getvalue()


def reaches_outside(run: Run, frame: MapFrame) -> bool:
    """Check whether the frame shows an area beyond the grid of the run."""
    return not _locate(run, *frame.pixels(_CHECKED))[2].all()


def _locate(run: Run, latitude: Array, longitude: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Compute fractional rows and columns of the fuel grid, and which places lie on the grid."""
    middle = 0.5 * float(run.fuel_longitude[0] + run.fuel_longitude[-1])
    longitude = areas.turned(longitude, middle)
    row, column = _fractions(run.fuel_latitude, latitude), _fractions(run.fuel_longitude, longitude)
    inside = (row >= -0.5) & (row <= len(run.fuel_latitude) - 0.5)
    inside &= (column >= -0.5) & (column <= len(run.fuel_longitude) - 0.5)
    return row, column, inside


def _hatching(shape: tuple[int, ...], dots: float) -> NDArray[np.uint8]:
    """Draw diagonal lines (rows, columns, 3) with `dots` pixels per mm."""
    row, column = np.indices(shape)
    every = max(round(_HATCH * dots), 4)
    thick = max(round(0.12 * every), 1)
    two = np.array([to_rgb(OUTSIDE), to_rgb(OUTSIDE_LINE)])
    return np.rint(255.0 * two[((row + column) % every < thick).astype(np.int64)]).astype(np.uint8)


def _cells(run: Run, frame: MapFrame) -> int:
    """Count the fuel cells across the frame."""
    cell = min(areas.cell_size(run.fuel_latitude, run.fuel_longitude))
    return int(np.ceil((frame.east - frame.west) / cell))


def _colours() -> NDArray[np.uint8]:
    """Compute colours (n, 256, 3) of `layers.ARRIVAL_PALETTE` over hill shading from 0 to 255."""
    grey = (_LIGHTEST - _RANGE * (1.0 - np.linspace(0.0, 1.0, 256)))[None, :, None]
    palette = np.array([to_rgb(colour) for colour in layers.ARRIVAL_PALETTE])[:, None, :]
    share = np.where(np.arange(len(palette)) > 0, OPACITY, 0.0)[:, None, None]
    return np.rint(255.0 * (grey * (1.0 - share) + palette * share)).astype(np.uint8)


def colours() -> list[str]:
    """Return the colours of arrival times as the picture shows them, earliest first."""
    return [mixed(each) for each in layers.ARRIVAL_PALETTE[2:]]


def mixed(colour: str) -> str:
    """Mix a colour of arrival times with the hill shading of level ground."""
    level = _LIGHTEST - _RANGE * (1.0 - np.sin(np.pi / 4.0))  # light from 45 degrees above the horizon
    made = level * (1.0 - OPACITY) + np.array(to_rgb(colour)) * OPACITY
    return "#" + "".join(f"{round(255.0 * value):02x}" for value in made)


def _fractions(axis: Array, places: Array) -> Array:
    """Convert degrees to fractional indices along an axis of cell centres; beyond half a cell: -1 or n."""
    order = np.argsort(axis)
    edges = areas.edges(axis[order]) if axis.size > 1 else axis[0] + np.array([-0.5, 0.5])
    at = np.interp(places, edges, np.arange(len(edges)) - 0.5, left=-1.0, right=len(axis))
    return at if axis[0] <= axis[-1] else len(axis) - 1.0 - at
