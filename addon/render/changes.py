"""Reasons why finished pictures and films are made again: their recorded inputs against the new ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from .. import timecode
from ..progress import count
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store

_NAMED = 3  # names in a list
_PARTS = {
    "run": "run",
    "beside": "comparison runs",
    "tiles": "tiles",
    "credits": "credits",
    "given": "sensors of the mount",
    "leader": "followed camera",
    "further": "other files of the scene",
}
"""Inputs of a picture that are named as a part."""


def of_picture(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """List what differs between the inputs of a picture: versions, settings by name, and other parts."""
    old, new = before.get("versions", {}), now.get("versions", {})
    found = [f"version of {name.title()}" for name in new if new[name] != old.get(name)]
    found += [name for part, name in _PARTS.items() if before.get(part) != now.get(part)]
    for part, name in (("sources", "code"), ("settings", "settings")):
        if names := _differing(before.get(part, {}), now.get(part, {})):
            found.append(f"{name} ({join_names(names)})")
    return found


def of_pictures(store: Store, pictures: Iterable[Picture], made_with: Fingerprints) -> list[str]:
    """List what differs between earlier and new inputs of pictures, of the first of each camera and pass."""
    first: dict[tuple[str, str], Picture] = {}
    for picture in pictures:
        first.setdefault((picture.camera, picture.name), picture)
    reasons = [
        of_picture(before, made_with[which]) or ["missing or damaged files"]
        for which, picture in first.items()
        if (before := store.inputs_of(picture.files()[0]))
    ]
    return list(dict.fromkeys(itertools.chain(*reasons)))


def of_film(before: dict[str, Any] | None, now: dict[str, Any]) -> list[str]:
    """List what differs between the inputs of a film, in words."""
    if before is None:
        return ["new"]
    changes = []
    if "timecode" not in before:
        changes.append("had no timecode track")
    if (codec := before.get("codec", "h264")) != now["codec"]:
        changes.append(f"codec was {codec}")
    if (rate := _rate(before["fps"])) != _rate(now["fps"]):
        changes.append(f"had {timecode.format_rate(rate)} frames per second")
    if before.get("captions") != now["captions"]:
        changes.append("other captions")
    if before.get("slate") != now.get("slate"):
        changes.append("other slate" if now.get("slate") else "had a slate")
    old, new = dict(before["frames"]), dict(now["frames"])
    if old.keys() != new.keys():
        changes.append(f"had {count(len(old), 'picture')}, now {len(new)}")
    if changed := sum(old[frame] != new[frame] for frame in old.keys() & new.keys()):
        changes.append(f"{changed} of {count(len(new), 'picture')} rendered again")
    return changes or ["missing or damaged"]


def describe_films(films: Iterable[tuple[str, list[str]]]) -> str:
    """Describe films (path, reasons) in a sentence: ``encoding a.mp4 and b.mp4 (had no timecode track)``."""
    groups: dict[str, list[str]] = {}
    for path, reasons in films:
        groups.setdefault("; ".join(reasons), []).append(path)
    return "encoding " + ", ".join(f"{join_names(paths)} ({reasons})" for reasons, paths in groups.items())


def join_names(names: Sequence[str]) -> str:
    """Join names: ``a, b and 5 more``."""
    more = len(names) - _NAMED
    shown = [*names[:_NAMED], f"{more} more"] if more > 0 else list(names)
    return " and ".join(filter(None, [", ".join(shown[:-1]), shown[-1]]))


def _differing(old: dict[str, Any], new: dict[str, Any], prefix: str = "") -> list[str]:
    """List the dotted names of values that differ."""
    keys = []
    for name in sorted(old.keys() | new.keys()):
        one, other = old.get(name), new.get(name)
        if isinstance(one, dict) and isinstance(other, dict):
            keys += _differing(one, other, f"{prefix}{name}.")
        elif one != other:
            keys.append(prefix + name)
    return keys


def _rate(stored: float | str) -> Fraction:
    """Return a recorded frame rate; films of older versions recorded a number."""
    return Fraction(stored) if isinstance(stored, str) else timecode.exact_rate(stored)
