"""Signs of stations: a plate with text on a stem, facing the camera at a constant size in the picture.

Near the camera a sign has all lines; farther away it has only the name. Both forms are labelled if the sign
shows data of an exercise. In small pictures letters are larger, to be legible, and signs have fewer
lines: the last ones of `stations.show` are left out first.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import owned
from ...shot.shot import Shot
from ...shot.stations.station_signs import Sign
from ...stations.records import EXERCISE
from ..labels import facing, lettering
from ..labels.lettering import Part
from . import material

_SMALL = 0.62  # letter height of the lines below the name, relative to the name
_GAP = 0.42  # between two lines, in letter heights
_EDGE = 0.35  # margin between text and the edge of the plate
_STEM, _HIGH = 0.09, 0.18  # picture heights: lowest plate above the ground; highest plate
_APART, _MOST = 0.3, 0.135  # between plates of two rows, letter heights; most between rows, picture heights
_SHORT = "Exercise"  # on the short form

_LETTERS, _PLATE = 0, 1


def build(shot: Shot, collection: bpy.types.Collection, shown: Sequence[Sign]) -> bpy.types.Object:
    """Build "Firetwin Signs"."""
    settings, looks = shot.settings.stations, material.signs(shot)
    library = owned.library("Station Signs")
    position = places(shot, shown)
    size = lettering.legible_size(shot, settings.size)
    near, far = forms(shot, shown, position, size)
    for number, parts in enumerate(near + far):
        mesh = lettering.mesh(f"Firetwin Sign {number:05d}", parts, looks)
        lettering.camera_rays_only(owned.add(library, f"Sign {number:05d}", mesh))
    detail = settings.detail, len(shown)
    group = facing.node_group(shot, material.TITLE, library, size, settings.distance, detail)
    return facing.points(collection, "Signs", position, group)


def places(shot: Shot, shown: Sequence[Sign]) -> NDArray[np.float64]:
    """Return the positions (n, 3) of signs on the ground, m."""
    return shot.ground.point([each.latitude for each in shown], [each.longitude for each in shown])


def forms(
    shot: Shot, shown: Sequence[Sign], position: NDArray[np.float64], size: float
) -> tuple[list[list[Part]], list[list[Part]]]:
    """Make the parts of signs, with all lines and with the name alone, for letters of this height."""
    rows = facing.tiers(shot, position)
    small = max(_SMALL, lettering.legible_size(shot, 0.0) / size)
    lines = [fitting(full(sign), small, _HIGH / size) for sign in shown], [short(sign) for sign in shown]
    shapes: tuple[list[list[Part]], list[list[Part]]] = ([], [])
    with lettering.typeface() as font:
        for form, parts in zip(lines, shapes, strict=True):
            highest = max((plate_height(each, small) for each in form), default=0.0)
            tier = min(highest + _APART, _MOST / size)
            for sign, text, row in zip(shown, form, rows, strict=True):
                low = _STEM / size + tier * int(row)
                parts.append(plate(text, low, material.accent(sign.origin), font, small))
    return shapes


def full(sign: Sign) -> list[tuple[str, bool]]:
    """Return the lines of a sign from top to bottom; True: in the colour of the origin."""
    return [(sign.name, False), *((line, line == EXERCISE) for line in sign.lines)]


def short(sign: Sign) -> list[tuple[str, bool]]:
    """Return the name, and the short label of an exercise."""
    return [(sign.name, False), *([(_SHORT, True)] if sign.exercise else [])]


def fitting(lines: list[tuple[str, bool]], small: float, high: float) -> list[tuple[str, bool]]:
    """Leave out lines, the last first, that make a plate higher than `high`; name and coloured lines stay."""
    shown = list(lines)
    while plate_height(shown, small) > high:
        plain = [k for k, (_, coloured) in enumerate(shown) if k and not coloured]
        if not plain:
            break
        del shown[plain[-1]]
    return shown


def plate_height(lines: Sequence[tuple[str, bool]], small: float) -> float:
    """Return the height of a plate, in heights of the name's letters."""
    more = len(lines) - 1
    return 2.0 * _EDGE + 1.0 + more * small + _GAP * (small * (more - 1) + 1.0 if more else 0.0)


def plate(
    lines: Sequence[tuple[str, bool]],
    low: float,
    accent: int,
    font: bpy.types.VectorFont | None,
    small: float = _SMALL,
) -> list[Part]:
    """Make a plate with text, and a bar and a stem in the accent colour; `low` is its lower edge.

    The name is one unit high, the other lines `small`.
    """
    parts, y = [], low + _EDGE
    for k, (text, coloured) in reversed(list(enumerate(lines))):
        size = small if k else 1.0
        parts.append(
            lettering.letters(text, y + 0.2 * size, 0.0, 0.03, font, accent if coloured else _LETTERS, size)
        )
        y += size + _GAP * (small if k > 1 else 1.0)
    wide = max((abs(x) for part in parts for x, _, _ in part.points), default=0.0) + _EDGE
    top = y - _GAP + _EDGE
    parts.append(lettering.rectangle(-wide, wide, low, top, 0.0, _PLATE))
    parts.append(lettering.rectangle(-wide, wide, low - 0.12, low, 0.01, accent))
    parts.append(lettering.stem(low - 0.12, accent))
    return parts
