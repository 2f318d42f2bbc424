"""Words and colours of the forecast pass."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from zoneinfo import ZoneInfo

from ...imaging.split_screen import HATCHED, Key
from ...imaging.split_screen import LINE as _LINED
from ...run import info, times
from ...shot.shot import Shot
from ...shot.surface.fronts import COLOURS as FRONTS
from .. import forecast
from ..ensemble.ensemble import Ensemble
from ._drawing import swatches

SHOWN, OUTLIER, LINE, HATCH = *FRONTS[:2], "#ffffff", "#d8d8d8"
_LONGEST = 40  # characters of a model's name
_KINDS = {"forecast": "member", "scenarios": "scenario", "ranked": "size rank", "ignitions": "ignition"}


@dataclass(frozen=True)
class Counts:
    """Numbers of a forecast picture.

    Attributes
    ----------
    moment
        Valid time, UTC.
    shown
        Index of the burning member.
    count
        Number of members that reach this time.
    drawn
        Indices of the other members whose fronts are drawn.
    hatched
        Ground in the picture was not simulated.
    """

    ensemble: Ensemble
    moment: datetime
    shown: int
    count: int
    drawn: tuple[int, ...]
    hatched: bool

    @property
    def kind(self) -> str:
        """Word for a member."""
        return _KINDS[self.ensemble.manifest.kind]


def caption(shot: Shot, counts: Counts) -> list[str]:
    """Name the shown member, the fire model, and the issue and valid times."""
    ensemble, manifest = counts.ensemble, counts.ensemble.manifest
    which = f"{counts.kind} {ensemble.members[counts.shown].name} of {len(ensemble.members)}"
    roles = ", ".join(forecast.roles(ensemble, counts.shown))
    model = _short(manifest.model or "model not given")
    return [
        *(["synthetic"] if shot.run.synthetic or manifest.synthetic else []),
        f"burning: {which}{f' ({roles})' if roles else ''}, {model}",
        *when(shot, counts),
    ]


def when(shot: Shot, counts: Counts) -> list[str]:
    """Name the issue time and the valid time."""
    zone = shot.settings.time.zone
    return [
        f"issued {times.text(counts.ensemble.issued, zone)}",
        f"valid {times.text(counts.moment, zone)}",
    ]


def member(ensemble: Ensemble, shown: int) -> list[str]:
    """Name a member of all, and its roles."""
    kind, roles = _KINDS[ensemble.manifest.kind], ", ".join(forecast.roles(ensemble, shown))
    return [f"{kind} {ensemble.members[shown].name} of {len(ensemble.members)}", *([roles] if roles else [])]


def part(counts: Counts, area: float) -> list[Key]:
    """Name the member of a part of a split screen, its roles, and the area (m2) that it has burned."""
    ensemble = counts.ensemble
    roles = ", ".join(forecast.roles(ensemble, counts.shown))
    name = f"{counts.kind} {ensemble.members[counts.shown].name}"
    keys = [(_LINED + SHOWN, f"{name}, {roles}" if roles else name)]
    return [*keys, ("", burned(area))]


def burned(area: float) -> str:
    """Format a burned area, m2."""
    return f"{area / info.ACRE:,.0f} acres ({area / 1e4:,.0f} ha) burned"


def legend(shot: Shot, counts: Counts, parts: int = 1) -> list[Key]:
    """Explain colours, lines and hatching; for several parts of a split screen, without lines."""
    ensemble, kind, count = counts.ensemble, counts.kind, counts.count
    total = len(ensemble.members)
    clock = f"{counts.moment.astimezone(ZoneInfo(shot.settings.time.zone)):%H:%M}"
    keys: list[Key] = []
    if shares := shot.settings.forecast.shares:
        colours = swatches(count)
        steps = list(zip(colours, ranges(count, len(colours)), strict=True))
        classes = [(colour, f"{k} of {count}") for colour, k in steps[::-1]]
        classes[0] = classes[0][0], f"{classes[0][1]} {kind}s"
        keys += [("", f"burned by {clock} in"), *classes]
        if len({member.weight for member in ensemble.members}) > 1:
            keys.append(("", "members count equally, weights not used"))
    if parts > 1:
        keys.append(("", f"{parts} of {total} {kind}s shown{', colours count all' * shares}"))
        keys.append(("", "typical and extreme ones, not equally likely"))
    else:
        keys.append((_LINED + SHOWN, f"front of {kind} {ensemble.members[counts.shown].name}, burning"))
        keys += _lines(counts, ", colours count all" if shares else "")
    if counts.hatched:
        keys.append((HATCHED, "not simulated"))
    if (ended := total - count) > 0:
        keys.append(("", f"{ended} of {total} ended before {clock}"))
    if ensemble.left_out:
        keys.append(("", f"{len(ensemble.left_out)} failed, not counted"))
    return keys


def _lines(counts: Counts, more: str) -> list[Key]:
    """Explain the fronts of other members, and how many are drawn."""
    ensemble, kind = counts.ensemble, counts.kind
    keys, plain = list[Key](), len(counts.drawn)
    outlier = forecast.outlier(ensemble)
    if outlier in counts.drawn:
        plain -= 1
        keys.append((_LINED + OUTLIER, f"front of {kind} {ensemble.members[outlier].name}, outlier"))
    if plain:
        keys.append((_LINED + LINE, f"front{'s' * (plain > 1)} of {plain} other {kind}{'s' * (plain > 1)}"))
    others = counts.count - 1
    if 0 < len(counts.drawn) < others:
        keys.append(("", f"{len(counts.drawn)} of {others} others drawn{more}"))
    return keys


def ranges(members: int, classes: int) -> list[str]:
    """List the counts of each class, fewest first: ``1 to 4``."""
    edges = [k * members // classes for k in range(classes + 1)]
    pairs = [(low + 1, high) for low, high in pairwise(edges)]
    return [f"{low}" if low == high else f"{low} to {high}" for low, high in pairs]


def _short(words: str) -> str:
    return words if len(words) <= _LONGEST else words[: _LONGEST - 1] + "…"
