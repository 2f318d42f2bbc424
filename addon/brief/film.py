"""Selected frames of a film, reduced in size, and its clips, as data URIs."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, UnidentifiedImageError

from ..errors import input_error
from ..html_text import data_uri, size
from ..progress import count
from ..render import manifest

WIDTH = 960  # maximum width of a frame, pixels
EACH = 3  # frames per camera and pass
MOST = 24  # maximum frames of a page
CLIP = 12_000_000  # maximum size of a clip, bytes
_QUALITY = 82  # of JPEG


@dataclass(frozen=True)
class Shown:
    """A frame or a clip in the page.

    Attributes
    ----------
    camera, name
        Camera and pass.
    time
        UTC of a frame; None for a clip, or if unknown.
    uri
        Data URI of the JPEG or MP4.
    """

    camera: str
    name: str
    time: datetime | None
    uri: str


@dataclass(frozen=True)
class Film:
    """Frames and clips of a folder, messages on omitted files, and versions of the programs that rendered."""

    frames: list[Shown]
    clips: list[Shown]
    left_out: list[str]
    versions: list[tuple[str, str]] = field(default_factory=list)


def read(out: Path, hashes: Mapping[str, str], room: int) -> Film:
    """Read frames and clips of an output folder of `firetwin render`.

    Parameters
    ----------
    hashes
        SHA-256 of fields of the page's run, by file.
    room
        Maximum size of all clips, bytes; the largest clips are omitted first.

    Raises
    ------
    InputError
        The folder has no finished pictures, they show another run, or one cannot be read.
    """
    content = manifest.read(out)
    entries = {path: entry for path, entry in content["files"].items() if _is_within(out, path)}
    _check_run(out, entries, content["settings"], hashes)
    pictures = _by_view((path, entry) for path, entry in entries.items() if path.endswith(".png"))
    clips = [
        path
        for path, entry in entries.items()
        if path.endswith(".mp4") and entry.get("film", "review") == "review" and (out / path).is_file()
    ]
    if not pictures and not clips:
        raise input_error(out, "has no finished pictures; name a folder of firetwin render --out")
    each = max(1, min(EACH, MOST // max(len(pictures), 1)))
    chosen = [picture for view in pictures.values() for picture in _spread(view, each)]
    left_out = []
    if len(chosen) > MOST:
        left_out.append(f"{count(len(chosen) - MOST, 'frame')} of further cameras and passes")
    frames = [_frame(out / path, entry) for path, entry in chosen[:MOST]]
    fitting, more = _clips(out, entries, clips, room)
    return Film(frames, fitting, left_out + more, manifest.versions(content["settings"].values()))


def _check_run(
    out: Path, entries: Mapping[str, dict[str, Any]], settings: Mapping[str, Any], hashes: Mapping[str, str]
) -> None:
    """Check that a film shows the page's run; views of comparison runs (``drone@slower``) may show others."""
    for path, entry in entries.items():
        known = settings.get(entry.get("settings", ""), {}).get("run", {})
        differing = [name for name in known.keys() & hashes.keys() if known[name] != hashes[name]]
        if differing and "@" not in entry.get("camera", ""):
            names = ", ".join(sorted(differing))
            reason = f"shows another run ({path} has other {names}); name a film of this run"
            raise input_error(out, reason)


def _is_within(out: Path, path: str) -> bool:
    """Check that a path of a manifest does not leave the folder."""
    return (out / path).resolve().is_relative_to(out.resolve())


def _by_view(
    pictures: Iterable[tuple[str, dict[str, Any]]],
) -> dict[tuple[str, str], list[tuple[str, dict[str, Any]]]]:
    """Group pictures by camera and pass, in the order of their frames."""
    found: dict[tuple[str, str], list[tuple[str, dict[str, Any]]]] = {}
    for path, entry in sorted(pictures):
        if {"camera", "pass"} <= entry.keys():
            found.setdefault((entry["camera"], entry["pass"]), []).append((path, entry))
    return found


def _spread(pictures: list[Any], most: int) -> list[Any]:
    """Select evenly spaced pictures with the first and the last; only the middle one if `most` is 1."""
    if most == 1:
        return [pictures[len(pictures) // 2]]
    index = np.unique(np.linspace(0, len(pictures) - 1, min(most, len(pictures))).round().astype(int))
    return [pictures[i] for i in index]


def _frame(path: Path, entry: dict[str, Any]) -> Shown:
    moment = entry.get("time")
    return Shown(
        entry["camera"], entry["pass"], datetime.fromisoformat(moment) if moment else None, _jpeg(path)
    )


def _jpeg(path: Path) -> str:
    try:
        with Image.open(path) as picture:
            small = picture.convert("RGB")
            small.thumbnail((WIDTH, 2 * WIDTH), Image.Resampling.LANCZOS)
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, ValueError, SyntaxError) as error:
        raise input_error(path, f"cannot be read ({error}); render it again with --resume") from None
    data = io.BytesIO()
    small.save(data, "JPEG", quality=_QUALITY, optimize=True)
    return data_uri("image/jpeg", data.getvalue())


def _clips(
    out: Path, entries: dict[str, dict[str, Any]], paths: list[str], room: int
) -> tuple[list[Shown], list[str]]:
    """Select clips, smallest first, and return them by name; also describe the clips that do not fit."""
    bytes_of = {path: (out / path).stat().st_size for path in paths}
    kept, left_out = set(), []
    for path in sorted(paths, key=lambda path: (bytes_of[path], path)):
        coded = 4 * -(-bytes_of[path] // 3)  # size in base64
        if bytes_of[path] > CLIP or coded > room:
            limit = (
                f"the limit of a clip is {size(CLIP)}"
                if bytes_of[path] > CLIP
                else "the page would be too large"
            )
            left_out.append(f"{path} of {size(bytes_of[path])}: {limit}")
            continue
        kept.add(path)
        room -= coded
    shown = [
        Shown(
            str(entries[path].get("camera", "")),
            str(entries[path].get("pass", "")),
            None,
            data_uri("video/mp4", (out / path).read_bytes()),
        )
        for path in paths
        if path in kept
    ]
    return shown, left_out
