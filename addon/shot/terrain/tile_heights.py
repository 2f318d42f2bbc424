"""Heights of 3D Tiles: their ground, as an elevation model for all objects on it, and their roofs."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import geo, tiles
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ... import files
from ...errors import input_error
from ...geometry.grids import dilate
from ...run.frame import local_frame
from . import rasterize

if TYPE_CHECKING:
    from ...tiles.decoded import Decoded

Array = NDArray[np.float64]
Known = Callable[[Array, Array], Array]
_MOST = 3000  # points along a side
_FINEST = 2.0  # m between points
_RIM = 2  # points
_THINNED = 8  # points from sample to sample of the known ground
_TURNS = 3  # a place's vertical leans away from the scene's by at most 0.5 degrees; 3 leave no 0.1 mm


def _level(east: Array, north: Array) -> Array:
    """Return level ground, for tiles over unknown ground."""
    return np.zeros(east.shape)


@dataclass(frozen=True)
class Surface:
    """Surface of tiles from above, on an even grid.

    Attributes
    ----------
    low
        (2,) east and north of the first point, scene metres.
    step
        m between points.
    height, ground
        (ny, nx) scene z of the highest surface, and of the ground below roofs and crowns, m; NaN without.
    shown
        (ny, nx) `tiles.GROUND`, `VEGETATION` or `BUILDING`: class of the highest surface.
    """

    low: Array
    step: float
    height: NDArray[np.float32]
    ground: NDArray[np.float32]
    shown: NDArray[np.uint8]


class TileHeights:
    """Heights of tiles at any place; the ground has the interface of `raster.GeoTiff`.

    Attributes
    ----------
    bounds
        West, south, east and north, degrees.
    resolution
        m.
    """

    unit = "m"

    def __init__(self, frame: geo.LocalFrame, surface: Surface) -> None:
        self.frame, self.surface, self.resolution = frame, surface, surface.step
        row, column = (np.flatnonzero(np.isfinite(surface.height).any(axis=axis)) for axis in (1, 0))
        ends = [
            (np.array([at[0], at[-1]]) if len(at) else np.zeros(2)) * surface.step for at in (column, row)
        ]
        east, north = (v.ravel() + side for v, side in zip(np.meshgrid(*ends), surface.low, strict=True))
        latitude, longitude, _ = frame.reverse(np.column_stack([east, north, np.zeros(4)]))
        self.bounds = longitude.min(), latitude.min(), longitude.max(), latitude.max()

    def overlaps(self, latitude: Array, longitude: Array) -> bool:
        """Return whether tiles are within the bounding box of these points, degrees."""
        west, south, east, north = self.bounds
        return bool(
            latitude.min() <= north
            and latitude.max() >= south
            and longitude.min() <= east
            and longitude.max() >= west
        )

    def on_grid(self, latitude: Array, longitude: Array) -> NDArray[np.float32]:
        """Heights (1, ny, nx) above the scene's datum, m, on axes in degrees; NaN without tiles."""
        height = np.zeros((len(latitude), len(longitude)))
        for _ in range(_TURNS):
            place = self.frame.forward_grid(latitude, longitude, np.nan_to_num(height))
            height = np.nan_to_num(height) + self.up(place[..., 0], place[..., 1]) - place[..., 2]
        return height.astype(np.float32)[None]

    def up(self, east: Array, north: Array) -> Array:
        """Scene z of the tiles' ground at scene coordinates, m; NaN without tiles."""
        return self._between(self.surface.ground, east, north)

    def top(self, east: Array, north: Array) -> Array:
        """Scene z of the highest surface at scene coordinates, m; NaN without tiles."""
        return self._between(self.surface.height, east, north)

    def growth(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Test for vegetation, and not a building, at scene coordinates or at a neighbouring point."""
        return self._at(self._growth, east, north)

    def building(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Test for a building at scene coordinates."""
        return self._at(self.surface.shown == tiles.BUILDING, east, north)

    def rim(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Test if places at scene coordinates are within `_RIM` points of the tiles' border, or outside."""
        row, column, outside = self._place(east, north)
        return outside | self._rim[np.round(row).astype(int), np.round(column).astype(int)]

    @cached_property
    def _growth(self) -> NDArray[np.bool_]:
        shown = self.surface.shown
        return dilate(shown == tiles.VEGETATION, 1, beyond=False) & (shown != tiles.BUILDING)

    @cached_property
    def _rim(self) -> NDArray[np.bool_]:
        return dilate(np.isnan(self.surface.height), _RIM, beyond=True)

    def _place(self, east: Array, north: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Fractional row and column within the grid, and whether the place is outside of it."""
        column, row = (
            (at - low) / self.resolution for at, low in zip((east, north), self.surface.low, strict=True)
        )
        rows, columns = self.surface.height.shape
        outside = (row < 0) | (column < 0) | (row > rows - 1) | (column > columns - 1)
        return np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1), outside

    def _between(self, values: NDArray, east: Array, north: Array) -> Array:
        row, column, outside = self._place(east, north)
        return np.where(outside, np.nan, bilinear(values, row, column))

    def _at(self, mask: NDArray[np.bool_], east: Array, north: Array) -> NDArray[np.bool_]:
        row, column, outside = self._place(east, north)
        return ~outside & mask[np.round(row).astype(int), np.round(column).astype(int)]


def rasterise(
    decoded: Iterable[Decoded], ground_height: Known = _level, buildings: Iterable[Sequence[Array]] = ()
) -> Surface:
    """Rasterise the surface of tiles.

    Parameters
    ----------
    ground_height
        Scene z of the known ground, m, at scene coordinates. The closer it is to the true ground, the better
        vegetation and buildings are separated from the ground.
    buildings
        Outlines of buildings, each as rings (n, 2) in scene metres.
    """
    decoded_tiles = list(decoded)
    corners = [tile.position[:, :2] + tile.origin[:2] for tile in decoded_tiles if len(tile.position)]
    low = np.min([each.min(axis=0) for each in corners], axis=0)
    high = np.max([each.max(axis=0) for each in corners], axis=0)
    step = max(float(np.max(high - low)) / _MOST, _FINEST)
    columns, rows = (np.ceil((high - low) / step).astype(int) + 1).tolist()
    surface = tiles.HeightMap(low.tolist(), step, rows, columns)
    for tile in decoded_tiles:
        surface.add(tile.position, tile.origin.tolist(), tile.triangle)
    height = surface.height
    below = _sampled(ground_height, low, step, (rows, columns))
    ground, shown = tiles.find_ground(height - below, step)
    for rings in buildings:
        if covered := rasterize.filled([(ring - low) / step + 0.5 for ring in rings], (rows, columns)):
            part = shown[covered[0]]
            part[(covered[1] > 0.5) & (part == tiles.VEGETATION)] = tiles.BUILDING
    return Surface(low, step, height, np.where(shown == tiles.GROUND, height, ground + below), shown)


def _sampled(known: Known, low: Array, step: float, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Heights (ny, nx) of a function, evaluated at every `_THINNED`th point."""
    coarse = [np.arange(0, count + _THINNED, _THINNED) * step for count in shape]
    east, north = np.meshgrid(low[0] + coarse[1], low[1] + coarse[0])
    sampled = known(east.ravel(), north.ravel()).reshape(east.shape)
    row, column = (np.arange(count) / _THINNED for count in shape)
    return bilinear(sampled, row[:, None], column).astype(np.float32)


def write(path: Path, surface: Surface) -> None:
    """Write a surface; its ground as depth below the highest surface, which is mostly 0."""
    arrays = asdict(surface)
    arrays["depth"] = surface.height - arrays.pop("ground")

    def put(part: Path) -> None:
        with part.open("wb") as stream:
            np.savez_compressed(stream, allow_pickle=False, **arrays)

    files.write(path, put)


def read(path: Path, run: Run) -> TileHeights:
    """Read a surface.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            low, step = stored["low"], float(stored["step"])
            height, depth, shown = (stored[name] for name in ("height", "depth", "shown"))
        even = height.ndim == 2 and height.shape == depth.shape == shown.shape
        if low.shape != (2,) or not even or not step > 0.0:
            raise ValueError("other shapes")
    except (OSError, ValueError, LookupError, zipfile.BadZipFile) as error:
        raise input_error(path, f"has no heights of tiles ({error}); delete it") from None
    return TileHeights(local_frame(run), Surface(low, step, height, height - depth, shown))
