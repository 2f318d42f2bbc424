"""Separate class, instance, smoke and the surface behind it of the rendered masks, and paint the classes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...shot.passes.masks import COLOURS, HIDES, NAMES, SMOKE
from ...shot.shot import Shot
from .. import exr_tags
from . import Files

_LEAST = 1.0e-4  # transmittance of smoke below which class numbers are inexact


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


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Separate classes, instances and smoke, and paint the classes."""
    names = ["class", "clear", "instance", "surface"]  # as EXR files sort them
    kind, instance, clear, surface = classes(sensor.read_image(files["exr"]))
    said = "class: " + ", ".join(f"{value} {name}" for value, name in enumerate(NAMES))
    about = exr_tags.attributes(shot, camera, frame, said)
    channels = np.stack([kind, np.clip(clear, 0.0, 1.0), instance, surface], axis=-1).astype(np.float32)
    sensor.write_image(files["exr"], channels, about, names)
    colours = np.array(COLOURS, np.float32) / 255.0
    sensor.write_image(files["png"], colours[kind.astype(np.int64)])
