"""Words and colours of the forecast pass."""

from __future__ import annotations

from itertools import pairwise
from zoneinfo import ZoneInfo

import numpy as np
from numpy.typing import NDArray

from ...imaging.split_screen import HATCHED, Key
from ...run import times
from ...run.ensemble.ensemble import Ensemble
from ...shot import forecast
from ...shot.shot import Shot
from ...shot.surface import fronts

COLOURS = ("#2b3a8f", "#3f6fc0", "#5aa2d8", "#93d0e8", "#e6f7ff")
"""Colours of the classes, fewest members first. Their lightness ascends, so that they differ without hue."""
SHOWN, LINE, HATCH = fronts.COLOURS[0], "#ffffff", "#d8d8d8"
_LONGEST = 40  # characters of a model's name
_KINDS = {"forecast": "member", "scenarios": "scenario", "ranked": "size rank", "ignitions": "ignition"}


def caption(shot: Shot, found: Ensemble, frame: int, shown: int) -> list[str]:
    """Name the shown member, the fire model, and the issue and valid times."""
    zone, manifest = shot.settings.time.zone, found.manifest
    roles = ", ".join(forecast.roles(found, shown))
    which = f"{_KINDS[manifest.kind]} {found.members[shown].name} of {len(found.members)}"
    model = _short(manifest.model or "model not given")
    return [
        *(["synthetic"] if shot.run.synthetic or manifest.synthetic else []),
        f"burning: {which}{f' ({roles})' if roles else ''}, {model}",
        f"issued {times.text(found.issued, zone)}",
        f"valid {times.text(shot.utc(frame), zone)}",
    ]


def legend(
    shot: Shot,
    found: Ensemble,
    frame: int,
    shown: int,
    counted: NDArray[np.int64],
    lines: int,
    hatched: bool,
) -> list[Key]:
    """Explain colours, lines and hatching."""
    count = len(counted)
    clock = f"{shot.utc(frame).astimezone(ZoneInfo(shot.settings.time.zone)):%H:%M}"
    keys: list[Key] = []
    if shot.settings.forecast.shares:
        colours = COLOURS[: max(min(count, len(COLOURS)), 1)]
        steps = list(zip(colours, ranges(count, len(colours)), strict=True))
        keys += [("", f"burned by {clock} in"), *((colour, f"{k} of {count}") for colour, k in steps[::-1])]
    kind = _KINDS[found.manifest.kind]
    keys.append((SHOWN, f"front of {kind} {found.members[shown].name}, burning"))
    if lines:
        keys.append((LINE, f"front{'s' * (lines > 1)} of {lines} other {kind}{'s' * (lines > 1)}"))
    if hatched:
        keys.append((HATCHED, "not simulated"))
    if (ended := len(found.members) - count) > 0:
        keys.append(("", f"{ended} of {len(found.members)} ended before {clock}"))
    if found.left_out:
        keys.append(("", f"{len(found.left_out)} failed, not counted"))
    return keys


def ranges(members: int, classes: int) -> list[str]:
    """List the counts of each class, fewest first: ``1 to 4``."""
    edges = [k * members // classes for k in range(classes + 1)]
    pairs = [(low + 1, high) for low, high in pairwise(edges)]
    return [f"{low}" if low == high else f"{low} to {high}" for low, high in pairs]


def _short(words: str) -> str:
    return words if len(words) <= _LONGEST else words[: _LONGEST - 1] + "…"
