"""Edit detection: compares camera objects with their state when built, to find an artist's edits."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import Any

import bpy

from ...blender import compat, owned, stored_json

POSE = ("location", "rotation_quaternion", "rotation_euler", "rotation_axis_angle", "scale")
LENS = ("lens", "sensor_width", "sensor_height", "ortho_scale")
_MADE = "firetwin_made"  # property of an object: its state when built


def store_state(obj: bpy.types.Object) -> None:
    """Store the current state of an object, for `changed_parts`."""
    obj[owned.NAME] = obj.name
    obj[_MADE] = json.dumps(_part_hashes(obj))


def changed_parts(obj: bpy.types.Object) -> set[str]:
    """Return which of "name", "pose" and "lens" an artist has changed since an object was built."""
    if _MADE not in obj:
        return set()
    before, now = stored_json.table(obj[_MADE]), _part_hashes(obj)
    return {part for part in now if now[part] != before.get(part)}


def _part_hashes(obj: bpy.types.Object) -> dict[str, str]:
    """Hash each part of an object over all frames."""
    hangs = [
        obj.parent.name if obj.parent else "",
        [_constraint_values(constraint) for constraint in obj.constraints],
    ]
    return {
        "name": obj.name,
        "pose": _digest([obj.rotation_mode, _values(obj, POSE), hangs]),
        "lens": _digest([obj.data.type, obj.data.sensor_fit, _values(obj.data, LENS)]),
    }


def _constraint_values(each: bpy.types.Constraint) -> list[Any]:
    target = getattr(each, "target", None)
    return [each.type, each.mute, each.influence, target.name if target else ""]


def _values(block: bpy.types.ID, names: Sequence[str]) -> list[Any]:
    """Return values of properties, or the F-curves of animated ones."""
    animated: dict[str, list[Any]] = {}
    for curve in compat.fcurves(block):
        if curve.data_path in names:
            points = [
                [*point.co, *point.handle_left, *point.handle_right, point.interpolation]
                for point in curve.keyframe_points
            ]
            animated.setdefault(curve.data_path, []).append([curve.array_index, points])
    still = {
        name: list(value) if hasattr(value := getattr(block, name), "__len__") else value
        for name in names
        if name not in animated
    }
    return [animated, still]


def _digest(values: Any) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:16]
