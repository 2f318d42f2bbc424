"""Drawing of the forecast passes: classes of colour, lines and hatching over a picture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import blur, dilate

COLOURS = ("#2b3a8f", "#3f6fc0", "#5aa2d8", "#93d0e8", "#e6f7ff")
"""Colours of the classes, fewest members first. Their lightness ascends, so that they differ without hue."""
_TINT = 0.7  # opacity of the tint (by eye)
_FEW, _MANY = 0.1, 1.0  # strength of the tint for the fewest and the most members (by eye)
_GROUND = 0.25  # brightness of medium ground in pictures, 0 to 1 (by eye)
_GREY = 0.8  # factor on the grey picture's brightness below it (by eye)
_FULL = 540  # rows from which on lines are opaque: on fewer they would be too heavy (by eye)
_CASING = 0.45  # opacity of the dark edge of a line (by eye)
_PERIOD = 45  # height / distance of hatching lines
_JUMP = 1.3  # ratio of distances in a 3 x 3 neighbourhood from which on it is the edge of a hill or tree

Array = NDArray[np.float32]


def palette(members: int) -> tuple[str, ...]:
    """Choose the colours of the classes, fewest members first: five, or one for each of fewer members."""
    return COLOURS[: max(min(members, len(COLOURS)), 1)]


def swatches(members: int) -> list[str]:
    """Return the colours of the classes as they appear on ground of medium brightness, fewest first."""
    colours = palette(members)
    kinds = np.arange(1, len(colours) + 1)[None]
    ground = np.full((1, len(colours), 3), _GROUND, np.float32)
    shown = tint(ground, kinds, colours, np.ones(kinds.shape, np.float32))[0]
    return ["#" + "".join(f"{round(255.0 * float(value)):02x}" for value in colour) for colour in shown]


def classes(counts: NDArray[np.int64], members: int) -> NDArray[np.int64]:
    """Classify counts of members: 0 for none, else 1 to the number of classes, each as wide as the others."""
    return -(-counts * len(palette(members)) // max(members, 1))


def clearness(layers: Mapping[str, Array]) -> Array:
    """Compute the share (h, w) of the picture's light that comes from ground that is not burning.

    Letters of labels count as nothing, so that colours leave them readable.
    """
    light = sum(layers[f"{name}.{c}"] for name in ("fire", "light_fire") for c in "RGB")
    every = sum(np.maximum(layers[c], 0.0) for c in "RGB")
    burning = np.clip(light / np.maximum(every, 1e-6), 0.0, 1.0)
    written = layers.get("labels.A", np.float32(0.0))
    return ((1.0 - np.clip(layers["smoke.A"], 0.0, 1.0)) * (1.0 - burning) * (1.0 - written)).astype(
        np.float32
    )


def tint(rgb: Array, kinds: NDArray[np.int64], colours: tuple[str, ...], clear: Array) -> Array:
    """Tint a picture (h, w, 3) by classes (h, w) of these colours, over its grey; class 0 stays.

    The tint is stronger for more members, so that ground that few burn does not stand out.
    """
    grey = _GREY * (rgb @ np.array([0.2126, 0.7152, 0.0722], np.float32))[..., None]
    shades = np.array([[0.0] * 3, *map(values, colours)], np.float32)[kinds]
    mixed = grey * (1.0 - _TINT) + shades * _TINT
    strength = np.array([0.0, *np.linspace(_FEW, _MANY, len(colours) + 1)[1:]], np.float32)[kinds]
    share = (clear * strength)[..., None]
    return rgb * (1.0 - share) + mixed * share


def over(rgb: Array, colour: str, opacity: Array) -> Array:
    """Draw a colour over a picture with an opacity (h, w)."""
    return rgb + (np.array(values(colour), np.float32) - rgb) * opacity[..., None]


def line(rgb: Array, border: Array, colour: str, clear: Array) -> Array:
    """Draw a border (see `outline`) as a line with a dark edge, as visible as the ground is."""
    strength = min(len(border) / _FULL, 1.0) ** 0.5
    edge = np.sqrt(blur(border[..., None])[..., 0])
    rgb = over(rgb, "#000000", _CASING * strength * clear * edge)
    return over(rgb, colour, strength * clear * border)


def outline(burned: NDArray[np.bool_]) -> Array:
    """Draw the border of an area (h, w) as a smooth line, 2 pixels wide or h / 360: 0 to 1."""
    share = burned[..., None].astype(np.float32)
    for _ in range(max(round(len(burned) / 720), 1)):
        share = blur(share)
    return np.sqrt(4.0 * share * (1.0 - share))[..., 0]


def smooth_ground(planar: Array) -> NDArray[np.bool_]:
    """Find pixels (h, w) away from the edges of hills and trees, where a border is not a front."""
    nearest = -dilate(-planar, 1)
    return dilate(planar, 1) < _JUMP * nearest


def stripes(height: int, width: int) -> NDArray[np.bool_]:
    """Draw diagonal lines over a picture (h, w)."""
    period = max(height // _PERIOD, 4)
    row, column = np.indices((height, width))
    return (row + column) % period < max(period // 4, 1)


def values(colour: str) -> tuple[float, ...]:
    """Convert a colour such as ``#ff8000`` to three values 0 to 1, display-referred as the picture is."""
    return tuple(int(colour[at : at + 2], 16) / 255.0 for at in (1, 3, 5))
