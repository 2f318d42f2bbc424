"""OpenTimelineIO file (.otio): the cut, a track for each camera, films and EXR sequences, and markers.

The file is JSON with the schemas Timeline.1, Stack.1, Track.1, Clip.2, Gap.1, ExternalReference.1,
ImageSequenceReference.1 and Marker.2. The media of a clip share one time, the timecode of the film, so that
its range lies in all of them.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from .. import timecode
from .cut import Clip, Edit, ImageSequence, Marker

FILM = "DEFAULT_MEDIA"
"""Key of the film among the media references of a clip."""

_DIGITS = 6


def text(edit: Edit) -> str:
    """Return the content of the file."""
    tracks = [
        _track(name, clips, edit.rate, enabled=position == 0)
        for position, (name, clips) in enumerate(edit.tracks)
    ]
    stack = _object("Stack.1", "tracks") | {
        "source_range": None,
        "effects": [],
        "markers": [_marker(each, edit.rate) for each in edit.markers],
        "enabled": True,
        "children": tracks,
    }
    start = _time(timecode.count_of_frame(1, edit.rate), edit.rate)
    return (
        json.dumps(_object("Timeline.1", edit.name) | {"global_start_time": start, "tracks": stack}, indent=1)
        + "\n"
    )


def _track(name: str, clips: Sequence[Clip], rate: Fraction, enabled: bool) -> dict[str, Any]:
    """Make a track, with gaps for missing frames."""
    children, frame = [], 1
    for clip in clips:
        if clip.first > frame:
            children.append(_item("Gap.1", "", _range(0, clip.first - frame, rate)))
        children.append(_clip(clip, rate))
        frame = clip.end
    return _item("Track.1", name, None) | {"enabled": enabled, "kind": "Video", "children": children}


def _clip(clip: Clip, rate: Fraction) -> dict[str, Any]:
    source, stretch, start = clip.film, clip.stretch, clip.film.start(rate)
    film = _object("ExternalReference.1", "") | {
        "available_range": _range(start - source.slate, source.length, rate),
        "available_image_bounds": None,
        "target_url": source.url,
    }
    sequences = {
        key: _sequence(each, stretch.first, _range(start + stretch.position, stretch.length, rate), rate)
        for key, each in source.sequences.items()
        if each.frames.issuperset(range(stretch.first, stretch.last + 1))
    }
    return _item("Clip.2", clip.title, _range(start + clip.position, clip.length, rate)) | {
        "media_references": {FILM: film, **sequences},
        "active_media_reference_key": FILM,
    }


def _sequence(images: ImageSequence, first: int, available: dict[str, Any], rate: Fraction) -> dict[str, Any]:
    return _object("ImageSequenceReference.1", "") | {
        "available_range": available,
        "available_image_bounds": None,
        "target_url_base": images.folder,
        "name_prefix": images.prefix,
        "name_suffix": images.suffix,
        "start_frame": first,
        "frame_step": 1,
        "rate": float(rate),
        "frame_zero_padding": _DIGITS,
        "missing_frame_policy": "error",
    }


def _marker(marker: Marker, rate: Fraction) -> dict[str, Any]:
    at = {"marked_range": _range(marker.frame - 1, 0, rate), "color": marker.colour, "comment": ""}
    return _object("Marker.2", marker.words) | at


def _item(schema: str, name: str, source_range: dict[str, Any] | None) -> dict[str, Any]:
    return _object(schema, name) | {
        "source_range": source_range,
        "effects": [],
        "markers": [],
        "enabled": True,
    }


def _object(schema: str, name: str) -> dict[str, Any]:
    return {"OTIO_SCHEMA": schema, "metadata": {}, "name": name}


def _range(start: int, length: int, rate: Fraction) -> dict[str, Any]:
    return {
        "OTIO_SCHEMA": "TimeRange.1",
        "start_time": _time(start, rate),
        "duration": _time(length, rate),
    }


def _time(frames: int, rate: Fraction) -> dict[str, Any]:
    return {"OTIO_SCHEMA": "RationalTime.1", "rate": float(rate), "value": float(frames)}
