"""Shared frames: frames filmed by one camera share smoke volumes with the shot of that camera alone."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from .. import files
from ..shot.shot import Shot
from . import sources


def frames(shot: Shot, wanted: Iterable[int]) -> list[tuple[Shot, list[int]]]:
    """Group the `wanted` frames filmed by a single camera, with the shot of that camera.

    A camera is excluded if the smoke of its shot has another resolution than with all cameras.
    """
    cameras = shot.settings.cameras
    if len(cameras) < 2 or shot.settings.smoke.complete or not shot.settings.render.cull:
        return []
    filmed = {camera.name: set(shot.frames_of(camera)) for camera in cameras}
    count = Counter(frame for listed_frames in filmed.values() for frame in listed_frames)
    own = {
        name: [frame for frame in wanted if count[frame] == 1 and frame in listed_frames]
        for name, listed_frames in filmed.items()
    }
    shots = [(shot.for_camera(name), listed) for name, listed in own.items() if listed]
    drawn = _resolution_inputs(shot) if shots else None
    return [(one, listed) for one, listed in shots if _resolution_inputs(one) == drawn]


def link(source: Path, place: Path, listed: Iterable[int]) -> None:
    """Hard-link volumes into another cache folder; copy where the file system has no links."""
    for path in (path for frame in listed for path in sorted(source.glob(f"*_{frame:06d}.vdb"))):
        files.write(place / path.name, functools.partial(files.link_or_copy, path))


def _resolution_inputs(shot: Shot) -> list[object]:
    """Return the camera-dependent inputs that determine the smoke's resolution."""
    source = sources.select(shot)
    return [source.inputs(), source.voxels()]
