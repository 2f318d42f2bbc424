"""Heights of 3-D Tiles as an elevation model, so that everything on the ground stands on the tiles."""

from __future__ import annotations

import hashlib
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import geo, tiles
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ... import files
from ...errors import input_error
from ...run.frame import local_frame

if TYPE_CHECKING:
    from ...tiles.decoded import Decoded
    from ..settings.settings import Settings

Array = NDArray[np.float64]
_MOST = 3000  # points along a side
_FINEST = 2.0  # m between points
_TURNS = 3  # a place's vertical leans away from the scene's by at most 0.5 degrees; 3 leave no 0.1 mm


class TileHeights:
    """Heights of tiles at any place, in the form of `raster.GeoTiff`.

    Parameters
    ----------
    low
        (2,) east and north of the first point, scene metres.
    step
        m between points.
    height
        (ny, nx) scene z of the highest surface, m; NaN without tiles.

    Attributes
    ----------
    bounds
        West, south, east and north, degrees.
    resolution
        m.
    """

    unit = "m"

    def __init__(self, frame: geo.LocalFrame, low: Array, step: float, height: NDArray[np.float32]) -> None:
        self.frame, self.low, self.resolution, self.height = frame, low, step, height
        row, column = (np.flatnonzero(np.isfinite(height).any(axis=axis)) for axis in (1, 0))
        ends = [(np.array([at[0], at[-1]]) if len(at) else np.zeros(2)) * step for at in (column, row)]
        east, north = (v.ravel() + side for v, side in zip(np.meshgrid(*ends), low, strict=True))
        latitude, longitude, _ = frame.reverse(np.column_stack([east, north, np.zeros(4)]))
        self.bounds = longitude.min(), latitude.min(), longitude.max(), latitude.max()

    def overlaps(self, latitude: Array, longitude: Array) -> bool:
        """Whether tiles lie within the bounding box of these points, degrees."""
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
        """Scene z at scene coordinates, m; NaN without tiles."""
        column, row = ((at - low) / self.resolution for at, low in zip((east, north), self.low, strict=True))
        rows, columns = self.height.shape
        outside = (row < 0) | (column < 0) | (row > rows - 1) | (column > columns - 1)
        found = bilinear(self.height, np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1))
        return np.where(outside, np.nan, found)


def rasterise(decoded: Iterable[Decoded]) -> tuple[Array, float, NDArray[np.float32]]:
    """First point (2,), step, and heights (ny, nx) of tiles' highest surface, as `TileHeights` takes them."""
    found = list(decoded)
    corners = [tile.position[:, :2] + tile.origin[:2] for tile in found if len(tile.position)]
    low = np.min([each.min(axis=0) for each in corners], axis=0)
    high = np.max([each.max(axis=0) for each in corners], axis=0)
    step = max(float(np.max(high - low)) / _MOST, _FINEST)
    columns, rows = (np.ceil((high - low) / step).astype(int) + 1).tolist()
    surface = tiles.HeightMap(low.tolist(), step, rows, columns)
    for tile in found:
        surface.add(tile.position, tile.origin.tolist(), tile.triangle)
    return low, step, surface.height


def location(settings: Settings, run: Run) -> Path:
    """File of the heights of a scene's tiles, which follows what they were chosen by."""
    frame = local_frame(run)
    parts = settings.tiles, settings.cameras, settings.time, settings.render.resolution
    digest = hashlib.sha256(repr((*parts, frame.latitude, frame.longitude)).encode())
    return settings.cache / "tiles" / f"heights-{digest.hexdigest()[:16]}.npz"


def write(path: Path, low: Array, step: float, height: NDArray[np.float32]) -> None:
    """Write heights (ny, nx)."""

    def put(part: Path) -> None:
        with part.open("wb") as stream:
            np.savez_compressed(stream, low=low, step=step, height=height)

    files.write(path, put)


def read(path: Path, run: Run) -> TileHeights:
    """Read heights.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            low, step, height = stored["low"], float(stored["step"]), stored["height"]
        if low.shape != (2,) or height.ndim != 2 or not step > 0.0:
            raise ValueError("other shapes")
    except (OSError, ValueError, LookupError, zipfile.BadZipFile) as error:
        raise input_error(path, 0, 0, f"has no heights of tiles ({error}); delete it") from None
    return TileHeights(local_frame(run), low, step, height)
