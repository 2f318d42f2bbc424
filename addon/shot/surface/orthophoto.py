"""Orthophoto: a user's georeferenced image as ground colours, reprojected to scene coordinates.

A GeoTIFF holds its own georeference. A PNG or JPEG has a world file (.pgw, .jgw or .wld) or
`terrain.photo_extent`, both in degrees. That of a server was fetched before (see `drape`).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import sensor
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...errors import InputError, input_error, reading
from ...files import read_text
from ...limits import SETTINGS_BYTES
from ...progress import Progress, silent
from ...run import areas, content
from ..schema import scene_text
from ..settings import Settings
from ..terrain.elevation import ramp
from ..terrain.raster import Array, GeoTiff, extent, format_bounds, overlap
from . import drape
from .drape_photo import DrapePhoto
from .photo_areas import areas_of, size_of
from .photo_source import PhotoSource, Pixels, between_pixels, rgba, thinned

if TYPE_CHECKING:
    from ..shot import Shot

_STRIP = 256  # rows that are resampled at once
_LATTICE = 128.0  # m between reprojected points; bilinear between, within 0.2 m in the sample run
_FADE = 6  # pixels at the border over which it fades into the synthetic ground
_TIFF = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


@dataclass(frozen=True)
class OrthophotoImage:
    """Ground colours of an area, seen from above.

    Attributes
    ----------
    low, high
        (2,) east and north of its corners, m.
    pixels
        (h, w, 4) sRGB colour and alpha; the southern row comes first.
    """

    low: Array
    high: Array
    pixels: Pixels


def check(settings: Settings, run: Run) -> None:
    """Validate an orthophoto: file type and overlap with the run.

    Raises
    ------
    InputError
        Names the file and what to do.
    """
    drape.check(settings, run)
    if settings.terrain.photo is None:
        if settings.terrain.photo_extent:
            where = "terrain", "photo_extent"
            raise scene_text.error_at(settings.path, where, "terrain.photo_extent needs a terrain.photo")
        return
    path = settings.terrain.photo
    if re.search("https?:/", path.as_posix()):
        reason = "terrain.photo is a file; a server's tiles are named by terrain.photo_url"
        raise scene_text.error_at(settings.path, ("terrain", "photo"), reason)
    if path.exists() and not path.is_file():  # opening a pipe would block
        reason = f"terrain.photo: {path} is not a file; name a GeoTIFF, PNG or JPEG"
        raise scene_text.error_at(settings.path, ("terrain", "photo"), reason)
    source = _file(settings)
    if not overlap(source.bounds, run.latitude, run.longitude):
        here = format_bounds(extent(run))
        raise source.error(f"covers {format_bounds(source.bounds)}, outside of the run, which covers {here}")


def inputs(settings: Settings, progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of the photo and of its world file, and the extent; or the address of a server's."""
    path = settings.terrain.photo
    if path is None:
        return drape.inputs(settings)
    parts = [path, *([world] if (world := world_file(path)) else [])]
    hashes = {f"photo {part.suffix}": content.of_file(part, settings.cache, progress) for part in parts}
    return hashes | {"photo extent": str(settings.terrain.photo_extent)}


def pictures(shot: Shot) -> list[OrthophotoImage]:
    """Make a picture of the complete photo, and a finer one near the cameras if the photo is finer."""
    if not photographed(shot.settings):
        return []
    source = source_of(shot)
    if isinstance(source, DrapePhoto):
        return [
            _picture(shot, source, np.array(area.low), np.array(area.high), area.step)
            for area in source.drape.areas
        ]
    step = max(source.resolution, _pixel(shot))
    return [_picture(shot, source, *area, step) for area in areas_of(shot, source.bounds, step)]


def photographed(settings: Settings) -> bool:
    """Return whether a scene has an orthophoto."""
    return bool(settings.terrain.photo or settings.terrain.photo_url)


def _pixel(shot: Shot) -> float:
    """Half of the smallest pixel (m) on the ground, at 200 m from perspective cameras."""
    sizes = [view.pixel * (200.0 if view.perspective else 1.0) for view in shot.paths]
    return 0.5 * min(sizes, default=1.0)


def _picture(shot: Shot, source: PhotoSource, low: Array, high: Array, step: float) -> OrthophotoImage:
    """Resample an area in strips, at `step` (m) or the coarser step that `photo_size` allows."""
    size = size_of(low, high, step, shot.settings.terrain.photo_size)
    pixels = np.zeros((size[1], size[0], 4), np.uint8)
    east, north = (low[k] + (np.arange(size[k]) + 0.5) / size[k] * (high[k] - low[k]) for k in (0, 1))
    place = _Places(shot, low, high)
    for first in range(0, size[1], _STRIP):
        rows = north[first : first + _STRIP]
        latitude, longitude = place(east, rows)
        colours = source.colours(latitude, longitude, float(np.min((high - low) / size)))
        colours[..., 3] = np.nan_to_num(colours[..., 3])
        pixels[first : first + len(rows)] = np.rint(255.0 * np.clip(np.nan_to_num(colours), 0.0, 1.0))
    known = pixels[..., 3] > 0
    soft = ramp(np.pad(known, 1), _FADE)[1:-1, 1:-1]
    pixels[..., 3] = np.rint(pixels[..., 3] * soft)
    return OrthophotoImage(low, high, pixels)


class _Places:
    """Latitude and longitude at scene coordinates, bilinear on a lattice of exact points."""

    def __init__(self, shot: Shot, low: Array, high: Array) -> None:
        counts = np.ceil((high - low) / _LATTICE).astype(int) + 1
        self.low, self.step = low, (high - low) / np.maximum(counts - 1, 1)
        counts = np.maximum(counts, 2)
        axes = [low[k] + np.arange(counts[k]) * self.step[k] for k in (0, 1)]
        east, north = (v.ravel() for v in np.meshgrid(*axes))
        self.fields = [v.reshape(counts[::-1]) for v in shot.ground.geodetic(east, north)]

    def __call__(self, east: Array, north: Array) -> list[Array]:
        """Degrees (n, m) at n norths and m easts."""
        row, column = (north - self.low[1]) / self.step[1], (east - self.low[0]) / self.step[0]
        return [bilinear(field, row[:, None], column) for field in self.fields]


def source_of(shot: Shot) -> PhotoSource:
    """Open the orthophoto of a shot that has one."""
    return DrapePhoto(drape.of_shot(shot)) if shot.settings.terrain.photo_url else _file(shot.settings)


def _file(settings: Settings) -> PhotoSource:
    path = settings.terrain.photo
    assert path is not None
    if not path.exists():
        reason = f"terrain.photo: no such file {path}"
        raise scene_text.error_at(settings.path, ("terrain", "photo"), reason)
    with reading(path):
        with path.open("rb") as stream:
            start = stream.read(8)
        return _Tiff(settings) if start.startswith(_TIFF) else _Plain(settings, path)


class _Tiff(PhotoSource):
    def __init__(self, settings: Settings) -> None:
        self.raster = GeoTiff(settings, "photo")
        self.bounds, self.resolution = self.raster.bounds, self.raster.resolution
        if self.raster.types[0] != "uint8":
            raise self.error(
                f"has {self.raster.types[0]} values; convert it to colours of 8 bits: "
                f"gdal_translate -ot Byte -scale {self.raster.path.name} OTHER.tif"
            )
        self.bands = {1: 1, 2: 2, 3: 3}.get(self.raster.count, 4)

    def error(self, reason: str) -> InputError:
        return self.raster.error(reason)

    def colours(self, latitude: Array, longitude: Array, step: float) -> NDArray[np.float32]:
        scale = areas.metres_per_degree(float(latitude.mean()))
        axes = _axis(latitude, step / scale[0]), _axis(longitude, step / scale[1])
        pixels = self.raster.on_grid(*axes, bands=self.bands) / np.float32(255.0)
        row, column = (
            (v - axis[0]) / (axis[1] - axis[0]) for v, axis in zip((latitude, longitude), axes, strict=True)
        )
        return rgba(between_pixels(np.moveaxis(pixels, 0, -1), row, column))


class _Plain(PhotoSource):
    def __init__(self, settings: Settings, path: Path) -> None:
        self.path = path
        pixels = sensor.read_image(self.path)
        self.pixels = np.rint(255.0 * np.clip(pixels, 0.0, 1.0)).astype(np.uint8)
        self.affine = self._affine(settings)
        height, width = self.pixels.shape[:2]
        corners = (
            np.array([[x, y, 1.0] for x in (-0.5, width - 0.5) for y in (-0.5, height - 0.5)]) @ self.affine.T
        )
        (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
        self.bounds = (west, south, east, north)
        if not (-90.0 <= south < north <= 90.0 and west < east <= west + 360.0 and abs(west) <= 360.0):
            raise self.error(
                "has a world file that is not in degrees; convert it to a GeoTIFF: "
                f"gdal_translate -a_srs EPSG:NNNN {self.path.name} OTHER.tif"
            )
        scale = np.array(areas.metres_per_degree(0.5 * (south + north)))
        metres = np.array([north - south, east - west]) * scale
        self.resolution = float(np.min(metres / (height, width)))

    def _affine(self, settings: Settings) -> Array:
        """Affine georeference (2, 3): longitude and latitude of pixel centres from column, row and 1."""
        extent = settings.terrain.photo_extent
        if extent:
            west, south, east, north = extent
            height, width = self.pixels.shape[:2]
            dx, dy = (east - west) / width, (south - north) / height
            return np.array([[dx, 0.0, west + 0.5 * dx], [0.0, dy, north + 0.5 * dy]])
        world = world_file(self.path)
        if world is None:
            raise self.error(
                "has no world file (.pgw, .jgw or .wld); georeference it with "
                "terrain.photo_extent = [west, south, east, north] in degrees"
            )
        with reading(world):
            words = read_text(world, most=SETTINGS_BYTES).split()
        try:
            a, d, b, e, c, f = map(float, words)
        except ValueError:
            raise input_error(world, "not a world file: it must hold six numbers, one a line") from None
        if not np.isfinite([a, d, b, e, c, f]).all() or abs(a * e - b * d) == 0.0:
            raise input_error(world, "not a world file: its pixels have no area")
        return np.array([[a, b, c], [d, e, f]])

    def error(self, reason: str) -> InputError:
        return input_error(self.path, reason)

    def colours(self, latitude: Array, longitude: Array, step: float) -> NDArray[np.float32]:
        inverse = np.linalg.inv(self.affine[:, :2])
        east = areas.turned(longitude, 0.5 * (self.bounds[0] + self.bounds[2])) - self.affine[0, 2]
        north = latitude - self.affine[1, 2]
        column, row = (inverse[k, 0] * east + inverse[k, 1] * north for k in (0, 1))
        size = max(int(step / self.resolution), 1)
        return rgba(
            between_pixels(self._thinned(size), (row + 0.5) / size - 0.5, (column + 0.5) / size - 0.5)
        )

    def _thinned(self, size: int) -> NDArray[np.float32]:
        """Average blocks of size x size pixels."""
        return self._means.setdefault(size, thinned(self.pixels, size))

    @cached_property
    def _means(self) -> dict[int, NDArray[np.float32]]:
        return {}


def _axis(values: Array, step: float) -> Array:
    """Even axis that covers these values with a margin."""
    low, high = values.min() - 2.0 * step, values.max() + 2.0 * step
    return np.linspace(low, high, max(int(np.ceil((high - low) / step)), 1) + 1)


def world_file(path: Path) -> Path | None:
    """World file of an image; None if there is none."""
    ends = {".png": ".pgw", ".jpg": ".jgw", ".jpeg": ".jgw"}.get(path.suffix.lower())
    names = [path.with_suffix(end) for end in (ends, ".wld") if end] + [Path(f"{path}w")]
    return next((name for name in names if name.is_file()), None)
