"""Camera edits: an artist's changes to camera objects, read into the panel's cameras."""

from __future__ import annotations

import bpy

from ..scene.camera import read_edits
from . import camera_list


def read_camera_edits(scene: bpy.types.Scene) -> list[str]:
    """Read the edits; return messages about edits that settings cannot express."""
    panel = scene.firetwin
    told: list[str] = []
    if not panel.frames:  # nothing is built
        return told
    before = camera_list.cameras(panel)
    size = tuple(panel.render.resolution)
    cameras = read_edits.update_cameras(scene, before, size, panel.frames, told.append)
    for item, old, new in zip(panel.cameras, before, cameras, strict=True):
        if new != old:
            camera_list.put(item, new)
    return told
