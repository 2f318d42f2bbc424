"""Stand of trees: hundreds per hectare near the cameras, fewer far away, and wider in films.

The core generates the trees (`forest.stand`). This module decides the area and the retained fraction for a
shot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from firetwin_core import forest as core
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...shot.shot import Shot
from ...shot.terrain import noise
from . import biomes, models, planted_rows, plot, stand_structure, visibility
from .plot import Plot

TALLEST = 42.0  # m; the core's largest tree
CLEARING = 25.0  # m around the cameras without any part of a trunk, for light and a free view
_PARTS = 0.33, 0.67, 1.0  # of a trunk, places that are compared with cameras
_PATCH = 90.0  # m, of trees of one species (by eye)
_GROUP = 150.0  # m, of conifers of one species in the Sierra (by eye)
_CROWN = 5.0  # m, width of a medium tree; where a pixel is wider, fewer trees give the same cover


@dataclass(frozen=True)
class Stand:
    """Trees of the stand, n of them.

    Attributes
    ----------
    position
        (n, 3) metres in the scene.
    height, rotation
        (n,) metres, radians.
    width
        (n,) ratio to the model's width.
    model
        (n,) index of the model in `models`.
    key
        (n, 2) integers that seed a tree's random choices.
    distance
        (n,) metres from the nearest camera in any frame.
    radius
        Draw distance of trees, m.
    complete
        Distance up to which the trees cover as much as the forest, m.
    """

    position: NDArray[np.float64]
    height: NDArray[np.float64]
    width: NDArray[np.floating]
    rotation: NDArray[np.float32]
    model: NDArray[np.int64]
    key: NDArray[np.int64]
    distance: NDArray[np.float64]
    radius: float
    complete: float = np.inf

    def coverage(self, distance: NDArray) -> NDArray[np.float64]:
        """Fraction 0..1 of the forest cover that trees represent at distances (m) from the cameras."""
        return _fade(distance, self.radius) * _retained_at(distance, self.complete)


def grow(shot: Shot, in_film: bool = True) -> Stand:
    """Generate the visible trees of the stand within `draw_distance`; none where the density is "paper".

    Parameters
    ----------
    in_film
        True if only the shot's cameras see the trees: crowns are widened by `forest.widening`.
    """
    settings = shot.settings
    reach = settings.forest.draw_distance
    plots = plot.plots(shot, TALLEST, reach) if settings.forest.density == "stand" else []
    widened = settings.forest.widening in ("always", "film" if in_film else "")
    stems, complete = _planted(shot, plots, widened)
    planted = planted_rows.planted(shot, stems.position)
    position = visibility.settled(shot.ground, planted_rows.align(shot, stems.position, planted))
    key = np.stack([stems.key >> 32, stems.key & 0xFFFFFFFF], axis=-1)
    distance = shot.visibility.distance(position)
    fade = _fade(distance, reach) if shot.pixel[1] > visibility.PIXEL else 1.0
    there = noise.uniform(key[:, 0], key[:, 1], settings.seed + 202) < fade
    there &= _is_clear_of_cameras(shot, position, stems.scale, distance)
    stands = noise.uniform(key[there, 0], key[there, 1], settings.seed + 203)
    there[there] = stands < stand_structure.retained(shot, position[there], planted[there])
    there[there] = visibility.visible(shot, position[there], stems.scale[there], reach, stems.width[there])
    chosen = np.flatnonzero(there)
    height = stems.scale[chosen].astype(float)
    width: NDArray[np.floating] = stems.width[chosen]
    if sorts := biomes.choose(shot).biome.species:
        model, height, width = _of_species(shot, sorts, position[chosen], height, width, key[chosen])
    else:
        model = _in_groups(shot, position[chosen], stems.size_class[chosen], key[chosen])
        model, height = _with_oaks(shot, position[chosen], model, height, key[chosen])
    rows = planted[chosen]
    if rows.any():
        height[rows] = planted_rows.heights(shot, position[chosen][rows], key[chosen][rows])
        model[rows] = np.array(models.CROP_PINES)[key[chosen][rows, 1] % len(models.CROP_PINES)]
    return Stand(
        position[chosen],
        height,
        width,
        stems.rotation[chosen],
        model,
        key[chosen],
        distance[chosen],
        reach if settings.forest.density == "stand" else 0.0,
        complete,
    )


def _is_clear_of_cameras(
    shot: Shot, position: NDArray[np.float64], height: NDArray[np.floating], distance: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Return which trees (n) of these heights (m) have their whole trunk beyond `CLEARING` from all cameras.

    `distance` is from a camera to the foot. A camera may fly between crowns, more than `CLEARING` above the
    ground.
    """
    clear: NDArray[np.bool_] = distance > CLEARING
    near = np.flatnonzero(clear & (distance < CLEARING + TALLEST))
    for part in _PARTS:
        up = np.stack([np.zeros(len(near)), np.zeros(len(near)), part * height[near]], axis=-1)
        clear[near] &= shot.visibility.distance(position[near] + up) > CLEARING
    return clear


class _Stems(NamedTuple):
    """Values of `core.Stems`, concatenated over all plots."""

    position: NDArray[np.float64]
    size_class: NDArray[np.uint8]
    model: NDArray[np.uint8]
    scale: NDArray[np.float32]
    width: NDArray[np.float32]
    rotation: NDArray[np.float32]
    key: NDArray[np.int64]


def _planted(shot: Shot, plots: list[Plot], widened: bool) -> tuple[_Stems, float]:
    """Stems of all plots, and the distance up to which they cover as much as the forest, m."""
    retained, full = _retained(shot, plots)
    planted = [
        core.stand(
            each.canopy_fuel,
            each.latitude,
            each.longitude,
            each.elevation,
            shot.local_frame,
            each.seed,
            retained=kept,
            mask=each.mask,
        )
        for each, kept in zip(plots, retained, strict=True)
    ]
    whole, number = np.empty(0, np.uint8), np.empty(0, np.float32)
    nothing = _Stems(np.empty((0, 3)), whole, whole, number, number, number, np.empty(0, np.int64))
    fields = (
        [getattr(nothing, name), *(getattr(stems, name) for stems in planted)] for name in _Stems._fields
    )
    stems = _Stems(*(np.concatenate(parts) for parts in fields))
    if widened:
        return stems, np.inf
    return stems._replace(width=np.ones_like(stems.width)), full / shot.pixel[0]


def _fade(distance: NDArray, reach: float) -> NDArray[np.float64]:
    """Fraction of trees drawn at a distance: 0 beyond `reach`, where the ground has the forest's colour."""
    return noise.smoothstep(reach, 0.75 * reach, distance) if reach > 0.0 else np.zeros_like(distance)


def _retained(shot: Shot, plots: list[Plot]) -> tuple[list[NDArray[np.float32]], float]:
    """Compute fractions (fy, fx) of stems to retain, and the pixel size (m) up to which they are 1.

    The pixel size at a point is the size for the sharpest camera at the distance of the nearest. All trees
    are retained if a pixel is smaller than a crown, or than the size at which `forest.budget` trees remain.
    """
    if shot.visibility.unculled:
        return [np.ones(each.mask.shape, np.float32) for each in plots], np.inf
    budget, reach = shot.settings.forest.budget, shot.settings.forest.draw_distance
    near, parallel = shot.pixel
    # Neighbouring cells as well: the retained fraction is bilinear between cell centres.
    besides = [dilate(each.mask, 1) for each in plots]
    pixels, stems = [], []
    for each, beside in zip(plots, besides, strict=True):
        distance = shot.visibility.distance(each.places(shot.local_frame, beside))
        pixels.append(np.minimum(distance * near if np.isfinite(near) else np.inf, parallel))
        fade = _fade(distance, reach) if parallel > visibility.PIXEL else 1.0
        stems.append(core.stems(each.canopy_fuel[beside]) * each.mask[beside] * fade * each.area)

    def count(full: float) -> float:
        return sum(float(np.sum(s * _retained_at(p, full))) for s, p in zip(stems, pixels, strict=True))

    low, high = 0.0, _CROWN
    if count(high) > budget:
        for _ in range(30):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if count(middle) < budget else (low, middle)
    made = []
    for each, beside, pixel in zip(plots, besides, pixels, strict=True):
        made.append(np.ones(each.mask.shape, np.float32))
        made[-1][beside] = _retained_at(pixel, high)
    return made, high


def _retained_at(pixel: NDArray[np.float64], full: float) -> NDArray[np.float64]:
    """Fraction of the stems to retain where pixels have this size (m): 1 up to `full`, then by area."""
    return np.minimum((full / np.maximum(pixel, 1.0e-6)) ** 2, 1.0)


def _of_species(
    shot: Shot,
    sorts: tuple[biomes.Species, ...],
    position: NDArray,
    height: NDArray,
    width: NDArray,
    key: NDArray[np.int64],
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Models, heights and widths of a biome's species, which grow in patches."""
    ground, seed = shot.ground, shot.settings.seed
    elevation = bilinear(ground.fields.elevation, *ground.under(position))
    share = np.array([_share(sort, elevation) for sort in sorts])
    part = np.cumsum(share, axis=0) / np.maximum(share.sum(axis=0), 1.0e-9)
    own = noise.uniform(key[:, 0], key[:, 1], seed + 222)
    lot = stand_structure.clustered_uniform(position, _PATCH, own, seed + 340)
    number = np.minimum((lot > part).sum(axis=0), len(sorts) - 1)
    which = noise.uniform(key[:, 0], key[:, 1], seed + 223)
    model = np.array(
        [sorts[k].models[int(u * len(sorts[k].models))] for k, u in zip(number, which, strict=True)], np.int64
    )
    taller, wider = (
        np.array([getattr(sort, name) for sort in sorts])[number] for name in ("height", "width")
    )
    return model, height * taller, width * wider


def _share(sort: biomes.Species, elevation: NDArray) -> NDArray[np.float64]:
    if sort.low is None or sort.high is None:
        return np.full(elevation.shape, sort.share)
    return sort.share * noise.smoothstep(sort.low, sort.high, elevation)


def _in_groups(
    shot: Shot, position: NDArray, size_class: NDArray[np.uint8], key: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Models of conifers by size class (`core.Stems`); species form groups, so that stands differ in hue."""
    first = np.array([models.FIRST_MODEL[k] for k in (0, 1, 2)])[size_class]
    count = np.array([4, 4, 2])[size_class]
    own = noise.uniform(key[:, 0], key[:, 1], shot.settings.seed + 224)
    lot = stand_structure.clustered_uniform(position, _GROUP, own, shot.settings.seed + 350)
    return first + np.minimum((lot * count).astype(np.int64), count - 1)


def _with_oaks(
    shot: Shot, position: NDArray, model: NDArray[np.int64], height: NDArray, key: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Models and heights with oaks among the trees of the foothills, half as tall."""
    ground, seed = shot.ground, shot.settings.seed
    elevation = bilinear(ground.fields.elevation, *ground.under(position))
    lot, kind = (noise.uniform(key[:, 0], key[:, 1], seed + 220 + use) for use in range(2))
    oak = lot < 0.75 * noise.smoothstep(1100.0, 600.0, elevation)
    return np.where(oak, models.OAKS[0] + (kind < 0.5), model), np.where(oak, 0.5 * height, height)
