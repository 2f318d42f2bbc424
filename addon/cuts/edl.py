"""Edit decision list (CMX 3600) of track V1, with markers as locators.

Record times begin at 01:00:00:00. A reel is a film; source times are the timecode of the film.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable
from urllib.parse import unquote

from .. import timecode
from .cut import Clip, Edit, Marker

RATES = frozenset({24, 25, 30, 48, 50, 60})
"""Nominal frame rates with a timecode (SMPTE ST 12-1, ST 12-3) that other programs read in an EDL."""

_REEL = 8  # characters
_RESERVED = frozenset({"AX", "BL", "BLACK", "BARS"})


def text(edit: Edit) -> str:
    """Return the content of the file."""
    names = reels(film.camera for film in edit.films)
    mode = "DROP FRAME" if timecode.is_drop_frame(edit.rate) else "NON-DROP FRAME"
    lines = [f"TITLE: {edit.name}", f"FCM: {mode}", ""]
    for number, clip in enumerate(edit.cut, 1):
        source = clip.film.frames[0] + clip.position
        spans = (source, source + clip.length, clip.first, clip.end)
        times = " ".join(timecode.of_frame(frame, edit.rate) for frame in spans)
        lines.append(f"{number:03d}  {names[clip.film.camera]:<{_REEL}} V     C        {times}")
        lines.append(f"* FROM CLIP NAME: {posixpath.basename(unquote(clip.film.url))}")
        lines.append(f"* FROM FILE: {clip.film.url}")
        lines += [
            f"* LOC: {timecode.of_frame(each.frame, edit.rate)} {each.colour:<7} {each.words}"
            for each in _markers(edit, number - 1)
        ]
    return "\n".join(lines) + "\n"


def reels(cameras: Iterable[str]) -> dict[str, str]:
    """Choose a reel for each camera: at most eight letters and digits, unique and not reserved."""
    reel_of: dict[str, str] = {}
    for camera in cameras:
        stem = re.sub(r"[^A-Z0-9]", "", camera.upper())[:_REEL] or "FILM"
        reel, number = stem, 1
        while reel in _RESERVED or reel in reel_of.values():
            number += 1
            reel = f"{stem[: _REEL - len(str(number))]}{number}"
        reel_of[camera] = reel
    return reel_of


def _markers(edit: Edit, index: int) -> list[Marker]:
    """Return the markers from a clip's start to the start of the next; the first has all earlier ones."""
    cut: tuple[Clip, ...] = edit.cut
    first = cut[index].first if index else 1
    end = cut[index + 1].first if index + 1 < len(cut) else None
    return [each for each in edit.markers if first <= each.frame and (end is None or each.frame < end)]
