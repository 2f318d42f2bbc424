"""Mask pass: semantic class and instance of each pixel, as ground truth for machine learning.

======== ===== =================================================================================
class    value content
======== ===== =================================================================================
sky      0     rays that hit nothing
ground   1     unburned ground, with shrubs, grass, rocks, water, and forest too far for single trees
burned   2     ground and shrubs behind the front
tree     3     living or burned
smoke    4     transmits less than half of the light behind it, in green
fire     5     flames in the air, on the ground and in crowns, and firebrands
building 6     blocks of footprints and of stations, burned or not; buildings in 3D Tiles are ground
======== ===== =================================================================================

The EXR has `class`; `clear`, the transmittance 0..1 of smoke; `instance`, the number of the tree or
building (0: none); `surface`, the class behind smoke, which is 4 only behind opaque smoke; and, if
`smoke.draw` is "integrated", `smoke_range`, the distance along the line of sight at which smoke reaches half
of its opacity, m, in blocks of 2 x 2 pixels (1e10: no smoke). The number of a building is its position among
the footprints, from 1. A tree has the same number in every frame, camera and film of a run with one `seed`:
it depends on the identity of the tree (see `numbers`), not on its index among built trees. Tree numbers are
24-bit hashes: about n^2 / 2^25 colliding pairs are expected among n visible trees. The PNG shows each class
in one colour. One ray goes through each pixel's centre without filtering, so numbers stay integers. Behind
opaque smoke the instance is unknown: 0. `clear` is measured with steps of one voxel up to an optical depth of
12: half steps differ by 5e-5 on average, and by 0.03 at most (frames 24 and 25 of the example). EEVEE writes
half floats, exact only for integers up to 2048, so `masks` rejects EEVEE.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..shot import exr_tags
from ..shot.passes import SURFACES, Files, RenderedPass
from ..shot.shot import Shot

ORDER = 27
HELP = (
    "Class masks (fire, smoke, tree, building, burned, ground, sky) and instance numbers, EXR and PNG; "
    "a tree has the same number in all frames, cameras and films"
)

SKY, GROUND, BURNED, TREE, SMOKE, FIRE, BUILDING = range(7)
NAMES = ("sky", "ground", "burned", "tree", "smoke", "fire", "building")
COLOURS = (
    (110, 170, 230),
    (196, 178, 128),
    (64, 56, 52),
    (38, 112, 52),
    (176, 176, 184),
    (255, 96, 16),
    (206, 72, 168),
)
SMOKE_RANGE = "smoke_range"
ALIGHT = 0.3  # fraction of full flame of ground and crowns from which a pixel counts as fire
HIDES = 0.5  # opacity from which a pixel counts as smoke


def numbers(key: NDArray, second: NDArray) -> NDArray:
    """Tree numbers (n,) from 1 to 2^24 - 1, exact in 32-bit floats, from two integers for each tree.

    Trees of a stand have the halves of 64 random bits. A single tree per cell has the cell and 0: these are
    unique in runs of up to 2^24 - 1 cells.
    """
    return 1 + (np.asarray(key, np.int64) ^ np.asarray(second, np.int64)) % (2**24 - 1)


PASS = RenderedPass(
    files=("exr", "png"),
    excludes=("lamps",),
    samples=1,
    shading="masks",
    channels="colour",
    pixel_centres=True,
    aspects=SURFACES | {"fire", "smoke"},
)

_LEAST = 1.0e-4  # transmittance of smoke below which class numbers are inexact
_NO_SMOKE = 1.0e10  # m


def classes(pixels: NDArray) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Separate pixels of `blender.nodes.mask_switch`.

    Returns
    -------
    class, instance, transmittance, and the class of the surface behind smoke (of opaque smoke: smoke),
    (h, w) each.
    """
    clear = pixels[..., 1].astype(np.float64)
    exact = clear > _LEAST
    low, code = (np.rint(np.where(exact, pixels[..., k] / np.where(exact, clear, 1.0), 0.0)) for k in (0, 2))
    surface = np.where(exact, code % 8, SMOKE)
    kind = np.where(clear > 1.0 - HIDES, surface, SMOKE)
    return kind, low + 4096.0 * (code // 8), clear, surface


def march(eye: Any, _frame: int) -> NDArray:
    """Return the pixels (h, w, 3) of `blender.nodes.mask_switch` with flames and smoke, and its distance."""
    pixels = eye.masks(eye.channels["Combined"])
    away = np.minimum(eye.smoke_range(pixels[..., 1]), _NO_SMOKE)
    return np.concatenate([pixels, away[..., None]], axis=-1)


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Separate classes, instances and smoke, and paint the classes."""
    pixels = sensor.read_image(files["exr"])
    kind, instance, clear, surface = classes(pixels)
    said = "class: " + ", ".join(f"{value} {name}" for value, name in enumerate(NAMES)) + "; smoke_range: m"
    about = exr_tags.attributes(shot, camera, frame, said)
    channels = {"class": kind, "clear": np.clip(clear, 0.0, 1.0), "instance": instance, "surface": surface}
    channels |= {SMOKE_RANGE: pixels[..., 3]} if pixels.shape[-1] > 3 else {}
    names = sorted(channels)  # as EXR files sort them
    values = np.stack([channels[name] for name in names], axis=-1).astype(np.float32)
    sensor.write_image(files["exr"], values, about, names)
    colours = np.array(COLOURS, np.float32) / 255.0
    sensor.write_image(files["png"], colours[kind.astype(np.int64)])
