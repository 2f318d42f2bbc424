"""Texts at places of a forecast picture: the roles of fronts, and names with numbers of members."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...imaging.split_screen import Mark
from ...shot.cameras.path import Path
from .. import forecast
from ._text import LINE, OUTLIER, Counts

_APART = 0.05  # picture heights between a labelled point and the other fronts, if there is room (by eye)
_CLEAR = 0.5  # visibility of ground from which on a front is labelled there (by eye)
_EDGES = 0.04, 0.96, 0.06, 0.94  # left, right, top and bottom limit of labels of fronts
_POINTS = 600  # points of a front that are tried, and points of all others that they avoid
_SMOKE = 0.25  # visibility of ground up to which smoke hides a place (by eye)
_HIDDEN = 0.97  # share of a place's distance at which something in front hides it (by eye)


def roles(
    counts: Counts, borders: Mapping[int, NDArray[np.float32]], clear: NDArray[np.float32]
) -> list[Mark]:
    """Label the outlier, the largest, the smallest and the typical member among the others.

    Parameters
    ----------
    borders
        Line (h, w) of each drawn member.
    clear
        (h, w) visibility of the ground.
    """
    ensemble, marks = counts.ensemble, list[Mark]()
    outlier = forecast.outlier(ensemble)
    lines = {member: np.argwhere(border * clear > _CLEAR) for member, border in borders.items()}
    for member in sorted(counts.drawn, key=lambda each: each != outlier):
        said = forecast.roles(ensemble, member)
        at = _free_point([lines[member], *(lines[k] for k in lines if k != member)], clear.shape)
        if said and at is not None:
            text = f"{ensemble.members[member].name} {', '.join(said[::-1])}"
            marks.append(Mark(at[1], at[0], text, OUTLIER if member == outlier else LINE))
    return marks


def _free_point(lines: Sequence[NDArray], shape: tuple[int, ...]) -> tuple[float, float] | None:
    """Choose a point (row, column) of the first line.

    It is the one nearest to the middle of the picture that is apart from the other lines, so that it moves
    slowly in a film; if none is, the one that is farthest from them.
    """
    height, width = shape
    left, right, top, bottom = _EDGES
    own = lines[0][:: max(len(lines[0]) // _POINTS, 1)].astype(np.float64)
    fits = (own[:, 1] > left * width) & (own[:, 1] < right * width)
    fits &= (own[:, 0] > top * height) & (own[:, 0] < bottom * height)
    if not fits.any():
        return None
    own, others = own[fits], np.concatenate([np.empty((0, 2)), *lines[1:]])
    others = others[:: max(len(others) // (4 * _POINTS), 1)]
    apart = np.full(len(own), np.inf)
    if len(others):
        apart = np.hypot(*(own[:, None] - others[None]).transpose(2, 0, 1)).min(axis=1)
    off = np.hypot(own[:, 0] - 0.5 * height, own[:, 1] - 0.5 * width)
    room = np.minimum(apart, _APART * height)
    best = own[np.lexsort((off, -room))[0]]
    return float(best[0]), float(best[1])


def visible(
    view: Path,
    frame: int,
    planar: NDArray[np.float32],
    clear: NDArray[np.float32],
    position: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Project points (n, 3), m, into a picture (h, w) with depth and visibility of the ground.

    Return pixels right and down (n, 2), NaN for points behind hills, smoke or flames.
    """
    local = (position - view.position[frame - 1]) @ view.rotation[frame - 1]
    depth = -local[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = local[:, :2] / (depth[:, None] if view.perspective else 1.0) / view.halves[frame - 1]
    height, width = planar.shape
    x, y = (at[:, 0] + 1.0) * 0.5 * width, (1.0 - at[:, 1]) * 0.5 * height
    seen = (depth > 0.0) & (x >= 0.0) & (x < width) & (y >= 0.0) & (y < height)
    row, column = (np.where(seen, each, 0.0).astype(np.int64) for each in (y, x))
    seen &= dilate(planar, 1)[row, column] >= _HIDDEN * depth
    seen &= clear[row, column] > _SMOKE
    return np.where(seen[:, None], np.stack([x, y], axis=-1), np.nan)


def names(
    named: Sequence[str], burned: NDArray[np.int64], members: int, at: NDArray[np.float64]
) -> list[Mark]:
    """Name visible places, with the number of members that have burned them.

    Parameters
    ----------
    burned
        (n,) numbers of members.
    members
        Number of all members; 0: leave out numbers.
    at
        (n, 2) pixels, NaN for places that are not visible.
    """
    marks = []
    for name, count, (x, y) in zip(named, burned.tolist(), at.tolist(), strict=True):
        if x == x:
            more = f": burned in {count} of {members}" if count and members else ""
            marks.append(Mark(x, y, f"{name}{more}"))
    return marks
