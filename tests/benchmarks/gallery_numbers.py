"""Numbers on the gallery's pictures, where taste argues.

Straight runs: what a grid leaves in a picture, stairs and walls, stands in lines along the picture's axes.
Smoke's outline: the perimeter-area dimension of what differs from the same picture without smoke. Clouds have
1.35 (Lovejoy 1982, Science 216), and 1.25 to 1.45 is what the gallery asks for.
Brightness: the median as it is shown, and the share of pixels with any channel at its end.
Needs NumPy and SciPy.
"""

from __future__ import annotations

import numpy as np
import smoke_pictures
from numpy.typing import NDArray

TOP = 0.08  # share of a picture's gradients that count as strong
LEAST = 1.5 / 255.0  # a pixel, the weakest gradient that counts: steps of 8 bits are no edges
RUNS = (9, 120)  # px, the shortest and longest run that is a grid's; longer ones are horizons
PURE = 0.1  # of the gradient across a run, what the one along it is at most: 6 degrees
HORIZON = 0.2  # of the picture's width: a row with so much of a straight edge is a horizon
BESIDE = 3  # px above and below a horizon that belong to it
CLIPPED = 0.995  # of a channel as it is shown
LIMITS = {
    "straight_per_cent": (0.0, 0.5),
    "dimension": (1.25, 1.45),
    "median": (0.1, 0.6),
    "clipped_per_cent": (0.0, 2.0),
    "front_seen": (0.5, 1.0),
}
"""What is asked for, lowest and highest."""

Picture = NDArray[np.float64]
Mask = NDArray[np.bool_]


def straight(brightness: Picture) -> tuple[float, Mask]:
    """Per cent of the strongest gradients that stand in straight runs, and where those are.

    A run goes down a column, or along a row, over strong gradients of one sign that point across it, to the
    tenth part: a grid's walls and stairs do so, sharp or blurred. A ridge that leans by more than 6 degrees
    is none, nor is the side of a puff, which turns.

    Parameters
    ----------
    brightness
        (rows, columns) as it is shown, 0 to 1.
    """
    up, right = np.gradient(brightness)
    strength = np.hypot(up, right)
    strong = (strength >= np.quantile(strength, 1.0 - TOP)) & (strength >= LEAST)
    if not strong.any():
        return 0.0, strong
    upright = strong & (np.abs(up) <= PURE * np.abs(right))
    level = strong & (np.abs(right) <= PURE * np.abs(up))
    level[_horizon(level)] = False
    found = _runs(upright, right) | _runs(level.T, up.T).T
    return 100.0 * float(found.sum()) / float(strong.sum()), found


def _runs(edges: Mask, across: Picture) -> Mask:
    """Edges in runs of one sign down the columns that are as long as is asked for."""
    found = np.zeros(edges.shape, bool)
    for side in (across > 0, across < 0):
        kept = np.pad(edges & side, [(1, 1), (0, 0)]).astype(np.int8)
        change = np.diff(kept, axis=0).T
        begin, end = (np.argwhere(change == way) for way in (1, -1))  # in the same order
        length = end[:, 1] - begin[:, 1]
        for k in np.flatnonzero((length >= RUNS[0]) & (length <= RUNS[1])):
            column, first = begin[k]
            found[first : end[k, 1], column] = True
    return found


def _horizon(level: Mask) -> Mask:
    """Which rows (rows,) belong to the horizon, if there is one: level edges across much of the picture."""
    count = level.sum(axis=1)
    rows = np.zeros(len(count), bool)
    best = int(count.argmax())
    if count[best] >= HORIZON * level.shape[1]:
        rows[max(best - BESIDE, 0) : best + BESIDE + 1] = True
    return rows


def shown(light: Picture, middle: float) -> Picture:
    """Light (rows, columns, 3) as a plain curve shows it, 0 to 1: `middle` of it comes out at half."""
    scaled = np.maximum(light, 0.0) / max(middle, 1e-12)
    return (scaled / (1.0 + scaled)) ** 0.8


def dimensions(light: Picture, clear: Picture, brighter: bool) -> dict[str, float]:
    """Perimeter-area dimension of the smoke's outline, and by rulers, for two thresholds.

    Parameters
    ----------
    light, clear
        Of one view, linear, with smoke and without; shown alike, whatever the exposures of their pictures.
    brighter
        Whether smoke is only what is brighter: from above, its shadow is none.
    """
    middle = float(np.median(light @ np.array([0.2126, 0.7152, 0.0722])))
    change = shown(light, middle) - shown(clear, middle)
    found = {}
    for threshold in smoke_pictures.THRESHOLDS:
        smoke = (change if brighter else np.abs(change)).max(axis=-1) > threshold
        dimension, blobs = smoke_pictures.outline(smoke)
        found |= {
            f"dimension_{threshold:g}": dimension,
            f"ruler_{threshold:g}": smoke_pictures.ruler(smoke),
            f"blobs_{threshold:g}": float(blobs),
            f"smoke_{threshold:g}": float(smoke.mean()),
        }
    return found


def dimension(found: dict[str, float]) -> float:
    """One number of `dimensions`: of blobs where there are enough, else by rulers; the mean of thresholds."""
    values = []
    for threshold in smoke_pictures.THRESHOLDS:
        blobs, ruler = found[f"dimension_{threshold:g}"], found[f"ruler_{threshold:g}"]
        values.append(blobs if np.isfinite(blobs) else ruler)
    known = [value for value in values if np.isfinite(value)]
    return float(np.mean(known)) if known else float("nan")


def median(brightness: Picture) -> float:
    """Of a picture's brightness as it is shown."""
    return float(np.median(brightness))


def clipped(colours: Picture) -> float:
    """Per cent of pixels (rows, columns, 3) of which any channel is at its end."""
    return 100.0 * float((colours.max(axis=-1) >= CLIPPED).mean())


def within(name: str, value: float) -> bool | None:
    """Whether a number is as is asked for; None where nothing is asked or known."""
    limits = LIMITS.get(name)
    if limits is None or not np.isfinite(value):
        return None
    return limits[0] <= value <= limits[1]
