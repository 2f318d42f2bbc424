"""Land use map: fields, tracks, roads, water and buildings of a vector file, rasterized onto the terrain.

The file is a GeoJSON or GeoPackage with polygons and lines in degrees. A feature's kind comes from its
OpenStreetMap tags (`building`, `highway`, `waterway`, `natural`, `landuse`) or from its property `kind`.
A second file has footprints alone: each of its polygons is a building.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...errors import input_error
from ...geometry.polygons import inside
from ...progress import Progress, silent
from ...run import content
from ...run.buildings import height_of, polygons
from ...run.observations import Feature, feature, features
from ..schema import scene_text
from ..settings import Settings
from ..shot import Shot, cached_on_shot
from ..terrain import noise
from ..terrain.raster import extent, format_bounds, overlap
from . import land_drawing
from .land_kinds import KINDS, LAYERS, SOLID, WIDTHS, LandUseKind, kind_of
from .orthophoto import OrthophotoImage

_LARGEST = 3072  # pixels, largest side of a picture
_FINEST = 0.5  # m, smallest pixel
_BEYOND = 50.0  # m around the map that count as mapped

Array = NDArray[np.float64]
Rings = tuple[Array, ...]


@dataclass(frozen=True)
class MappedFeature:
    """A map feature in scene coordinates.

    Attributes
    ----------
    kind
        One of `KINDS`.
    polygons
        Polygons, each a list of rings (n, 2), the outer first; east and north, m.
    lines
        Lines (n, 2), east and north, m.
    width
        Line width, m.
    height
        Height that a building has by its properties, m; None where they give none.
    number
        Index in the file.
    """

    kind: str
    polygons: tuple[Rings, ...]
    lines: Rings
    width: float
    height: float | None
    number: int


@dataclass(frozen=True)
class LandUseMap:
    """Land use map in scene coordinates.

    Attributes
    ----------
    features
        Features of both files.
    low, high
        Corners (2,) of the extent of all, m.
    known
        Corners (2,) of the extent of the land use, m, in which nothing is invented; None without that file.
    """

    features: tuple[MappedFeature, ...]
    low: Array
    high: Array
    known: tuple[Array, Array] | None


def check(settings: Settings, run: Run) -> None:
    """Validate a land use map: file type and overlap with the run.

    Raises
    ------
    InputError
        Names the file and what to do.
    """
    terrain = settings.terrain
    for path, found in ((terrain.land_use, _read(settings)), (terrain.buildings, _footprints(settings))):
        if path is None:
            continue
        corners = np.concatenate([ring for item in found for ring in _rings(item)])
        (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
        bounds = (float(west), float(south), float(east), float(north))
        if not overlap(bounds, run.latitude, run.longitude):
            here = format_bounds(extent(run))
            reason = f"covers {format_bounds(bounds)}, outside of the run, which covers {here}"
            raise input_error(path, reason)


def inputs(settings: Settings, progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of the map and of the footprints, on which colours and roofs depend."""
    named = {"land use": settings.terrain.land_use, "buildings": settings.terrain.buildings}
    return {name: content.of_file(path, settings.cache, progress) for name, path in named.items() if path}


@cached_on_shot
def read_map(shot: Shot) -> LandUseMap | None:
    """Land use and footprints of a shot; None if there are none."""
    settings = shot.settings
    if settings.terrain.land_use is None and settings.terrain.buildings is None:
        return None
    return _placed(shot, _read(settings), _footprints(settings))


@cached_on_shot
def pictures(shot: Shot) -> dict[str, list[OrthophotoImage]]:
    """Pictures of each map layer: the whole map, and finer ones near the cameras."""
    land = read_map(shot)
    if land is None:
        return {}
    frames = _frames(shot, land)
    present = {KINDS[feature.kind].layer for feature in land.features}
    layers = [layer for layer in LAYERS if layer in present or (layer == "soft" and "water" in present)]
    return {layer: [_drawn(shot, land, layer, *frame) for frame in frames] for layer in layers}


def mapped(shot: Shot, place: Array) -> NDArray[np.bool_]:
    """Test if points (n, 2) in the scene, m, are within the extent of the land use map."""
    known = read_map(shot)
    if known is None or known.known is None:
        return np.zeros(len(place), bool)
    low, high = known.known
    return np.all((place[:, :2] > low - _BEYOND) & (place[:, :2] < high + _BEYOND), axis=1)


def planted(shot: Shot, place: Array) -> NDArray[np.bool_]:
    """Test if points (n, 2 or 3) in the scene, m, are in plantations of the map."""
    is_planted = np.zeros(len(place), bool)
    known = read_map(shot)
    for each in known.features if known else ():
        if each.kind == "plantation":
            for polygon in each.polygons:
                is_planted |= inside(polygon, place[:, :2])
    return is_planted


def hedges(shot: Shot, place: Array) -> NDArray[np.bool_]:
    """Test if points (n, 2 or 3) in the scene, m, are in hedges of the map."""
    is_hedge = np.zeros(len(place), bool)
    known = read_map(shot)
    for each in known.features if known else ():
        if each.kind != "hedge":
            continue
        for polygon in each.polygons:
            is_hedge |= inside(polygon, place[:, :2])
        for line in each.lines:
            is_hedge |= _beside(line, 0.5 * each.width, place)
    return is_hedge


def _beside(line: Array, reach: float, place: Array) -> NDArray[np.bool_]:
    """Test if points (n, 2 or 3) are within `reach` of a line."""
    low, high = line.min(axis=0) - reach, line.max(axis=0) + reach
    near = np.all((place[:, :2] >= low) & (place[:, :2] <= high), axis=1)
    off = np.full(int(near.sum()), np.inf)
    for a, b in pairwise(line):
        along, to = b - a, place[near, :2] - a
        part = np.clip(to @ along / max(float(along @ along), 1.0e-12), 0.0, 1.0)
        off = np.minimum(off, np.hypot(*(to - part[:, None] * along).T))
    near[near] = off <= reach
    return near


def keeps_out(shot: Shot, place: Array) -> NDArray[np.bool_]:
    """Plant exclusion mask of points (n, 2 or 3) in the scene, m: water, roads, fields and buildings."""
    out = np.zeros(len(place), bool)
    for layer, drawn in pictures(shot).items():
        for picture in drawn:
            size = np.array(picture.pixels.shape[1::-1])
            at = np.floor((place[:, :2] - picture.low) / (picture.high - picture.low) * size).astype(int)
            inside = np.flatnonzero(np.all((at >= 0) & (at < size), axis=1))
            x, y = at[inside].T
            out[inside] |= picture.pixels[y, x, 3] > 255.0 * (SOLID if layer == "soft" else 0.5)
    return out


def buildings(shot: Shot) -> list[Rings]:
    """Outlines of the map's buildings, each as rings (n, 2) in scene metres."""
    known = read_map(shot)
    return (
        [part for each in known.features if each.kind == "building" for part in each.polygons]
        if known
        else []
    )


def _read(settings: Settings) -> list[tuple[str, Feature]]:
    """Read the features of known kinds; none without a file.

    Raises
    ------
    InputError
    """
    path = settings.terrain.land_use
    if path is None:
        return []
    where = "terrain", "land_use"
    if path.suffix.lower() not in (".geojson", ".json", ".gpkg"):
        raise scene_text.error_at(settings.path, where, f"terrain.land_use: {path} is no .geojson or .gpkg")
    if not path.is_file():
        raise scene_text.error_at(settings.path, where, f"terrain.land_use: no such file {path}")
    every = features(path)
    assert isinstance(every, list)  # of these formats
    known = [(kind, item) for item in every if (kind := kind_of(item.properties)) and _rings((kind, item))]
    if not known:
        reason = f"has no polygon or line with OpenStreetMap's tags or a kind of {', '.join(KINDS)}"
        raise input_error(path, reason)
    return known


def _footprints(settings: Settings) -> list[tuple[str, Feature]]:
    """Read the footprints, every polygon of which is a building; none without a file.

    Raises
    ------
    InputError
    """
    path = settings.terrain.buildings
    if path is None:
        return []
    if not path.is_file():
        where = "terrain", "buildings"
        raise scene_text.error_at(settings.path, where, f"terrain.buildings: no such file {path}")
    return [("building", each) for each in polygons(path)]


def _rings(feature_of_kind: tuple[str, Feature]) -> list[feature.Ring]:
    _, item = feature_of_kind
    return [*(polygon[0] for polygon in item.polygons), *item.lines]


def _placed(
    shot: Shot, mapped: list[tuple[str, Feature]], footprints: list[tuple[str, Feature]]
) -> LandUseMap:
    def scene(ring: Array) -> Array:
        return shot.bare_ground.point(ring[:, 1], ring[:, 0])[:, :2]

    features = []
    for number, (kind, each) in enumerate([*mapped, *footprints]):
        words = {key.lower(): str(value).lower() for key, value in each.properties.items()}
        width = feature.finite(words.get("width", "").removesuffix("m"))
        usual = WIDTHS.get(words.get("highway", words.get("waterway", "")), KINDS[kind].width)
        features.append(
            MappedFeature(
                kind,
                tuple(tuple(map(scene, polygon)) for polygon in each.polygons),
                tuple(map(scene, each.lines)),
                min(width or usual, 200.0),
                height_of(each.properties),
                number,
            )
        )
    order = list(KINDS)
    features.sort(key=lambda item: order.index(item.kind))
    low, high = _extent(features)
    own = [item for item in features if item.number < len(mapped)]
    return LandUseMap(tuple(features), low, high, _extent(own) if own else None)


def _extent(features: list[MappedFeature]) -> tuple[Array, Array]:
    """Corners (2,) of the bounding box of features, m."""
    rings = [ring for item in features for ring in (*(p[0] for p in item.polygons), *item.lines)]
    every = np.concatenate(rings)
    return every.min(axis=0), every.max(axis=0)


def _frames(shot: Shot, known: LandUseMap) -> list[tuple[Array, Array]]:
    """Corners of the pictures to draw: the whole map, and areas near cameras."""
    ground = shot.ground
    low, high = known.low - _BEYOND, known.high + _BEYOND
    frames = [(low, high)]
    if len(ground.eyes) and np.max(high - low) / _LARGEST > 2.0 * _FINEST:
        eyes = ground.eyes[:, :2]
        radius = min(ground.near_radius, 1500.0)
        near = np.clip(eyes.min(axis=0) - radius, low, high), np.clip(eyes.max(axis=0) + radius, low, high)
        if np.all(near[1] - near[0] > 10.0) and np.max(near[1] - near[0]) < 0.7 * np.max(high - low):
            frames.append(near)
    return frames


def _drawn(shot: Shot, known: LandUseMap, layer: str, low: Array, high: Array) -> OrthophotoImage:
    """Rasterize one layer of the map."""
    size = np.clip(np.ceil((high - low) / _FINEST), 2, _LARGEST).astype(int)
    picture = land_drawing.LandPicture(low, high, size)
    for mapped in known.features:
        kind = KINDS[mapped.kind]
        if kind.layer == layer:
            _draw(picture, mapped, kind, shot.settings.seed)
        elif layer == "soft" and kind.layer == "water":
            for line in (*(ring for polygon in mapped.polygons for ring in polygon), *mapped.lines):
                land_drawing.draw_bank(picture, line, 0.0 if mapped.polygons else mapped.width)
    return OrthophotoImage(low, high, picture.pixels)


def _draw(picture: land_drawing.LandPicture, mapped: MappedFeature, kind: LandUseKind, seed: int) -> None:
    """Draw a feature in one of its colours, a little lighter or darker than others."""
    lot, bright = noise.uniform([mapped.number] * 2, [7, 8], seed)
    choice = int(lot * len(kind.colours))
    red, green, blue = (float(part * (0.92 + 0.16 * bright)) for part in kind.colours[choice])
    colour = red, green, blue
    for polygon in mapped.polygons:
        if kind.patterns:
            land_drawing.draw_field(picture, polygon, colour, kind.strength, kind.patterns[choice])
        else:
            land_drawing.draw_area(picture, polygon, colour, kind.strength)
    for line in mapped.lines:
        if mapped.kind == "track":
            land_drawing.draw_track(picture, line, mapped.width, colour)
        elif mapped.kind == "road":
            land_drawing.draw_road(picture, line, mapped.width, colour)
        else:
            picture.blend(picture.stroked(line, mapped.width), colour, kind.strength)
