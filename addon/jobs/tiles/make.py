"""Writer of 3D tiles of a scene's ground: elevation, orthophoto or fuel colours, and buildings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...errors import UsageError
from ...progress import MessageCallback, Progress, no_message, silent
from ...run import areas, buildings
from ...shot.shot import Shot
from ...shot.surface import orthophoto
from ...shot.terrain import noise
from ...shot.tiles import tile_terms
from ...staging import staging
from ...tiles import geoid, notices
from ...tiles.make.lattice import Lattice, Surface
from ...tiles.make.tileset import Maker, TilesetSummary, refuse_others

Array = NDArray[np.float64]
_FINEST = 4097  # points along an axis of an elevation model
_BARE, _GREEN = (146.0, 136.0, 120.0), (58.0, 76.0, 44.0)
"""sRGB of ground without fuel, and with the run's largest load, without a photo (assumed)."""

_FINER = 4.0  # pixels of the mottled picture in a cell of the run
_MOTTLE, _CONTRAST = 220.0, 0.22  # m, largest mottles; their contrast (by eye)


@dataclass(frozen=True)
class TilesRequest:
    """Request for a tileset.

    Attributes
    ----------
    out
        Folder of the tileset.
    levels
        Depth of the quadtree; None: by the spacing of the heights.
    footprints
        File of buildings' footprints; None: the scene's file, if any.
    geoid
        Height of the geoid above the WGS84 ellipsoid, m; None: EGM96. It is added to orthometric heights.
    credit
        Credit of the data; empty: the run, and the credit of the scene's orthophoto.
    overwrite
        Replace files of others (see `output`).
    """

    out: Path
    levels: int | None = None
    footprints: Path | None = None
    geoid: float | None = None
    credit: str = ""
    overwrite: bool = False


def run(
    shot: Shot,
    request: TilesRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
) -> TilesetSummary:
    """Write a tileset.

    Raises
    ------
    InputError
        The folder has other files, the footprints cannot be read, or the heights come from tiles whose
        terms forbid export.
    """
    refuse_others(request.out)
    if shot.settings.terrain.height_source == "tiles":
        tile_terms.check(shot.settings, [("export", "`firetwin tiles make`")])
    surface = ground_surface(shot, request.geoid)
    built = []
    if path := request.footprints or shot.settings.terrain.buildings:
        found = buildings.read(path)
        tell(found.summary())
        north, east = areas.metres_per_degree(float(surface.latitude.mean()))
        built = buildings.place_on_ground(
            found.outlines, lambda at: _heights(surface, at[:, 1], at[:, 0]), (east, north)
        )
    lattice = Lattice(surface, request.levels)
    photo = orthophoto.photographed(shot.settings)
    colours = _PhotoColours(shot) if photo else _FuelColours(shot)
    credit = request.credit or default_credit(shot, photo)
    with staging(request.out, request.overwrite) as folder:
        return Maker(lattice, colours, built, folder, credit).run(progress)


def default_credit(shot: Shot, photo: bool) -> str:
    """Compose the credit of a shot's run and, with `photo`, of its orthophoto."""
    run = f"{shot.run.name}, synthetic" if shot.run.synthetic else shot.run.name
    return "; ".join([run, *(notices.split(shot.settings.terrain.photo_credit) if photo else [])])


def ground_surface(shot: Shot, undulation: float | None) -> Surface:
    """Compute heights of a shot's ground above the ellipsoid, at the resolution of the run or a finer model.

    Parameters
    ----------
    undulation
        Height of the geoid, m; None: EGM96. It is added if the run's heights are orthometric.

    Raises
    ------
    UsageError
        This machine has no grid of EGM96.
    """
    fields, relief = shot.ground.fields, shot.relief
    inside = slice(fields.margin, -fields.margin or None)
    latitude, longitude = fields.latitude[inside], fields.longitude[inside]
    height = fields.elevation[inside, inside]
    if relief.model:
        step = float(np.min(np.diff(latitude))) * areas.metres_per_degree(float(latitude.mean()))[0]
        times = max(int(np.ceil(step / relief.model.resolution)), 1)
        rows, columns = (np.linspace(0, n - 1, min(times * (n - 1) + 1, _FINEST)) for n in height.shape)
        coarse = bilinear(height, rows[:, None], columns)
        latitude = np.interp(rows, np.arange(len(latitude)), latitude)
        longitude = np.interp(columns, np.arange(len(longitude)), longitude)
        height = relief.mixed(latitude, longitude, coarse)[0]
    if shot.run.vertical == "orthometric":
        height = height + (_egm96(latitude, longitude) if undulation is None else undulation)
    return Surface(latitude, longitude, height.astype(np.float32))


def _egm96(latitude: Array, longitude: Array) -> Array:
    """Compute the heights (ny, nx) of the geoid on axes in degrees, m."""
    found = geoid.find()
    if found is None:
        raise UsageError(f"--geoid: {geoid.REMEDY}")
    return found.height(latitude[:, None], longitude)


def _heights(surface: Surface, latitude: Array, longitude: Array) -> Array:
    rows = np.interp(latitude, surface.latitude, np.arange(len(surface.latitude), dtype=float))
    columns = np.interp(longitude, surface.longitude, np.arange(len(surface.longitude), dtype=float))
    return bilinear(surface.height, rows, columns).astype(np.float64)


class _FuelColours:
    """Ground colours by fuel load, mottled: greener is denser."""

    def __init__(self, shot: Shot) -> None:
        fields = shot.ground.fields
        self._ground = shot.ground
        load = fields.canopy_fuel + fields.surface_fuel
        self._load = load / max(float(load.max()), 1.0e-9)
        self.resolution = float(min(shot.ground.cell)) / _FINER
        self._sizes = areas.metres_per_degree(shot.ground.frame.latitude)

    def __call__(self, latitude: Array, longitude: Array) -> NDArray[np.uint8]:
        rows, columns = self._ground.indices(latitude, longitude)
        load = bilinear(self._load, rows[:, None], columns)[..., None]
        colour = np.asarray(_BARE) * (1.0 - load) + np.asarray(_GREEN) * load
        return np.rint(np.clip(colour * self._mottles(latitude, longitude)[..., None], 0, 255)).astype(
            np.uint8
        )

    def _mottles(self, latitude: Array, longitude: Array) -> Array:
        """Return factors (h, w) about 1: soil, stains and shade, no finer than two pixels."""
        y, x = latitude * self._sizes[0], longitude * self._sizes[1]
        step = abs(y[-1] - y[0]) / max(len(y) - 1, 1)
        octaves = int(np.clip(np.log2(_MOTTLE / max(2.0 * step, 1e-6)) + 1.0, 0, 5))
        return np.clip(1.0 + _CONTRAST * noise.fractal(x, y[:, None], _MOTTLE, octaves, 71, 0.7), 0.4, 1.6)


class _PhotoColours:
    """Ground colours of a scene's orthophoto, and by fuel outside of it."""

    def __init__(self, shot: Shot) -> None:
        self._photo, self._fuel = orthophoto.source_of(shot), _FuelColours(shot)
        self.resolution = self._photo.resolution

    def __call__(self, latitude: Array, longitude: Array) -> NDArray[np.uint8]:
        rows, columns = np.meshgrid(latitude, longitude, indexing="ij")
        step = (
            abs(latitude[-1] - latitude[0]) / len(latitude) * areas.metres_per_degree(float(latitude[0]))[0]
        )
        photo = np.nan_to_num(self._photo.colours(rows, columns, float(step)))
        alpha = photo[..., 3:]
        colours = self._fuel(latitude, longitude) * (1.0 - alpha) + 255.0 * photo[..., :3] * alpha
        return np.rint(np.clip(colours, 0.0, 255.0)).astype(np.uint8)
