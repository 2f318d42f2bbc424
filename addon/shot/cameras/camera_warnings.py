"""Camera warnings: ridges in front of targets, and mono rendering of headset cameras."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..sections.camera import CameraSettings
from ..terrain.terrain import Terrain
from .path import Path


def mono_vr(cameras: Sequence[CameraSettings]) -> list[str]:
    """Warn of headset cameras that have one eye only in a scene shared with other cameras."""
    around = [camera.name for camera in cameras if camera.rig.around]
    if not around or len(around) == len(cameras):
        return []
    return [
        f'camera "{name}" has one eye in a scene that other cameras are in; firetwin render, or a scene '
        "with it alone, gives both"
        for name in around
    ]


def ridges(paths: Iterable[Path], ground: Terrain) -> list[str]:
    """Warn of ridges that raised a camera or that occlude its target."""
    return [text for view in paths if (text := _ridges(view, ground))]


def _ridges(view: Path, ground: Terrain) -> str:
    hidden = np.zeros(1) if view.hidden is None else view.hidden
    if hidden.max() <= 0.0:
        return ""
    worst, frames = int(np.argmax(hidden)), f"{int((hidden > 0.0).sum())} of {len(view.position)} frames"
    if view.camera.rig.over_ridges:
        return (
            f'camera "{view.camera.name}" flies up to {hidden[worst]:,.0f} m higher than its keys say, '
            f"to see its target over ridges in {frames} (over_ridges = true)"
        )
    place = view.position[worst]
    above = place[2] + hidden[worst] - ground.up(place[0], place[1])[0]
    return (
        f'camera "{view.camera.name}" has ridges before its target in {frames}; {above:,.0f} m above the '
        "ground would see over them all (over_ridges = true raises it)"
    )
