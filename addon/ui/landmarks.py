"""Landmarks: the ignition, and the head of the fire at each frame, stored with the scene at a build."""

from __future__ import annotations

import functools
from typing import Any

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ..blender import stored_json

HEAD, IGNITION = "Head of the fire", "Ignition"

_WORDS = {"head": HEAD, "head of the fire": HEAD, "ignition": IGNITION}


def list_names(panel: bpy.types.PropertyGroup) -> list[str]:
    """Return the names of the scene's landmarks."""
    found = _read(panel.landmarks)
    if not found or found["ignition"] is None:
        return []
    return [HEAD, IGNITION]


def find(panel: bpy.types.PropertyGroup, text: str) -> Vector | None:
    """Return the scene position of the head at the current frame, or of the ignition, by name."""
    name = _WORDS.get(text.strip().lower())
    if name not in list_names(panel):
        return None
    if name == IGNITION:
        return Vector(_read(panel.landmarks)["ignition"])
    return Vector(head_track(panel)[min(max(panel.id_data.frame_current, 1), panel.frames) - 1])


def head_track(panel: bpy.types.PropertyGroup) -> NDArray[np.float64]:
    """Return positions (frames, 3) of the head, above the ground."""
    found = _read(panel.landmarks)
    head, every = found["head"], np.arange(1, panel.frames + 1)
    return np.stack([np.interp(every, found["frames"], head[:, axis]) for axis in range(3)], axis=-1)


@functools.lru_cache(maxsize=4)
def _read(text: str) -> dict[str, Any]:
    """Parse stored landmarks; none if the text is not as `built.landmarks_text` writes it."""
    found = stored_json.table(text)
    try:
        ignition, frames, head = (found[name] for name in ("ignition", "frames", "head"))
        arrays = {"frames": np.array(frames, float), "head": np.array(head, float)}
        began = None if ignition is None else np.array(ignition, float)
    except (KeyError, TypeError, ValueError, OverflowError):
        return {}
    count = len(arrays["frames"]) if arrays["frames"].ndim == 1 else 0
    shapes = arrays["head"].shape == (count, 3) and (began is None or began.shape == (3,))
    return arrays | {"ignition": began} if count and shapes else {}
