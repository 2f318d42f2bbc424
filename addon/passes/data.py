"""Data for compositors: depth, normals, positions, motion, Cryptomatte and temperatures in one EXR.

It is made from the files of `depth`, `normal`, `masks` and `thermal`; it adds no rays.

===================================== ==================================================================
channels                              content
===================================== ==================================================================
`Z`                                   planar depth, m; the sky is 1e10
`N.X`, `N.Y`, `N.Z`                   normals: east, north, up; the sky is 0
`P.X`, `P.Y`, `P.Z`                   positions, m east, north and up of the scene's origin; the sky is 0
`forward.u`, `forward.v`              motion to the next frame, pixels right and up
`backward.u`, `backward.v`            motion to the previous frame, pixels right and up
`CryptoClass00` to `02`, r g b a      classes: sky, ground, burned, tree, smoke, fire, building
`CryptoTree00` to `02`, r g b a       single trees, alight or not, by names such as `tree_00001234`
`thermal.kelvin`, `thermal.radiance`  as in `thermal`
`smoke.Z`                             planar depth at which smoke reaches half of its opacity, m
===================================== ==================================================================

`smoke.Z` is in blocks of 2 x 2 pixels, and 1e10 without smoke (opacity below 1 %). Cycles, which draws smoke
if `smoke.draw` is "volume", does not measure it: files then have no such channel.

Normals are of one ray through the pixel's centre, and noisy in foliage (see `normal`).

Motion is computed from the camera before a static scene: smoke, flames and firebrands have none. The first
frame has no backward motion, and the last no forward motion.

Cryptomatte has six ranks. One ray goes through each pixel's centre; coverage is the mean of the 3 x 3 nearest
rays with weights 1, 2, 1. Edges are therefore soft, but not measured by the rays of `rgb`, and details
smaller than a pixel are noisy. Smoke covers 1 - its transmittance, and the surface behind it the rest. Flames
that hide more than half are fire, and others are not. Class coverages add up to 1. The JSON is the manifest
of the trees in the frame; the EXR has its name (`manif_file`), so keep both files in one folder, and do not
rename the JSON. The number of a tree is its instance number in `masks`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..geometry import grids
from ..imaging import cryptomatte
from ..shot import exr_tags
from ..shot.cameras import pixel_rays
from ..shot.cameras.path import Path
from ..shot.passes import DerivedPass, Files
from ..shot.shot import Shot
from .masks import FIRE, NAMES, SMOKE, SMOKE_RANGE, TREE

ORDER = 43
HELP = "Depth, normals, positions, motion, Cryptomatte and temperatures for compositors, 32-bit EXR"

PASS = DerivedPass(
    files=("exr", "json"),
    single_view=True,
    aspects=frozenset({"time", "camera", "picture"}),
    linked=("json",),
    needs=("depth", "normal", "masks", "thermal"),
)

CLASSES, TREES = "CryptoClass", "CryptoTree"
_NAMES = (
    *("Z", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"),
    *("forward.u", "forward.v", "backward.u", "backward.v"),
    *cryptomatte.channels(CLASSES),
    *cryptomatte.channels(TREES),
    *("thermal.kelvin", "thermal.radiance"),
)
_SAID = "Z, P, smoke.Z: m; forward, backward: pixels right and up; thermal: K and W m-2 sr-1"
_ROWS = 64  # of a picture whose trees are ranked together, to limit memory
_NEAR = ((1, 1), (0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2))
_WEIGHTS = np.array([4, 2, 2, 2, 2, 1, 1, 1, 1], np.float32)[:, None, None] / 16
"""Position of neighbours in a 3 x 3 block, and their weights, which `grids.blur` has too."""

Array = NDArray[np.float32]


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Collect the channels, and write the manifest of the trees."""
    view = pixel_rays.path_of(shot.paths, camera)
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    masks = sensor.read_channels(needed["masks"]["exr"])
    thermal = sensor.read_channels(needed["thermal"]["exr"])
    trees, numbers = mark_trees(masks["surface"], masks["instance"], masks["clear"])
    classes = cryptomatte.identify(NAMES)
    values: list[NDArray] = [
        planar[..., None],
        sensor.read_image(needed["normal"]["exr"])[..., :3],
        np.nan_to_num(pixel_rays.points(view, frame, planar)),
        *(move(view, frame, planar, frame + step) for step in (1, -1)),
        cryptomatte.ranked(classes, np.moveaxis(cover_classes(masks["surface"], masks["clear"]), -1, 0)),
        trees,
        *(thermal[name][..., None] for name in ("kelvin", "radiance")),
    ]
    files["json"].write_text(cryptomatte.manifest(numbers) + "\n", encoding="utf-8", newline="\n")
    named = dict(zip(NAMES, classes, strict=True))
    about = exr_tags.attributes(shot, camera, frame, _SAID)
    about |= cryptomatte.attributes(CLASSES, cryptomatte.manifest(named))
    about |= cryptomatte.attributes(TREES, files["json"].name, is_file=True)
    names = list(_NAMES)
    if SMOKE_RANGE in masks:
        names.append("smoke.Z")
        values.append(pixel_rays.planar_depths(view, frame, masks[SMOKE_RANGE])[..., None])
    pixels = np.concatenate([each.astype(np.float32) for each in values], axis=-1)
    sensor.write_image(files["exr"], pixels, about, names, one_line=True)


def move(view: Path, frame: int, planar: Array, other: int) -> Array:
    """Compute the motion (h, w, 2) of pixels to another frame; 0 if the film does not have that frame."""
    if not 1 <= other <= len(view.position):
        return np.zeros((*planar.shape, 2), np.float32)
    return pixel_rays.motion(view, frame, planar, other)


def cover_classes(surface: Array, clear: Array) -> Array:
    """Compute the coverage (h, w, 7) of each class of `masks`, which adds up to 1.

    Parameters
    ----------
    surface, clear
        (h, w) class behind smoke, and transmittance of smoke.
    """
    cover = (surface[..., None] == np.arange(len(NAMES))) * clear[..., None]
    cover[..., SMOKE] += 1.0 - clear
    return grids.blur(cover).astype(np.float32)


def mark_trees(surface: Array, instance: Array, clear: Array) -> tuple[Array, dict[str, np.float32]]:
    """Rank the trees of each pixel.

    Parameters
    ----------
    surface, instance, clear
        (h, w) class behind smoke, number, and transmittance of smoke.

    Returns
    -------
    Channels (h, w, 12), and the identifier of each tree by name.
    """
    number = np.where(np.isin(surface, (TREE, FIRE)), instance, 0.0).astype(np.int64)
    present, place = np.unique(number, return_inverse=True)
    names = [f"tree_{each:08d}" for each in present.tolist()]
    hashes = cryptomatte.identify(names)
    held = hashes[place.reshape(number.shape)]
    cover = np.where(number > 0, clear, 0.0).astype(np.float32)
    held, cover = (np.pad(each, 1, mode="edge") for each in (held, cover))
    height, width = number.shape
    layers = np.empty((height, width, 2 * cryptomatte.RANKS), np.float32)
    for top in range(0, height, _ROWS):
        rows = min(_ROWS, height - top)
        around = (
            np.stack([each[top + j : top + j + rows, i : i + width] for j, i in _NEAR])
            for each in (held, cover)
        )
        numbers, shares = around
        layers[top : top + rows] = cryptomatte.ranked(numbers, shares * _WEIGHTS)
    return layers, {name: each for name, each in zip(names, hashes, strict=True) if name != "tree_00000000"}
