"""Render devices of Cycles: CPU, or GPU by OptiX, CUDA, HIP, oneAPI or Metal."""

from __future__ import annotations

import bpy

from ..errors import TryAgainError

KINDS = ("OPTIX", "CUDA", "HIP", "ONEAPI", "METAL")  # ordered by speed
_NAMES = {"OPTIX": "OptiX", "CUDA": "CUDA", "HIP": "HIP", "ONEAPI": "oneAPI", "METAL": "Metal"}


def set_device(wanted: str, scene: bpy.types.Scene) -> str:
    """Set the device ("auto", "cpu" or "gpu") of a scene, in a separate Blender process.

    It changes Blender's preferences, so it must not run in an artist's Blender: see `follow_preferences`.

    Returns
    -------
    Description of the device.

    Raises
    ------
    TryAgainError
        A GPU is requested and there is none.
    """
    kind, names = ("NONE", []) if wanted == "cpu" else _gpus()
    if wanted == "gpu" and not names:
        tried = ", ".join(_NAMES.values())
        raise TryAgainError(
            f'device = "gpu", but Cycles finds no GPU here (tried {tried}); set it to "auto" or "cpu"'
        )
    scene.cycles.device = "GPU" if names else "CPU"
    if not names:
        return "the processor" + ("" if wanted == "cpu" else " (no GPU found)")
    preferences = _preferences()
    assert preferences is not None  # or names is empty
    preferences.compute_device_type = kind
    for device in preferences.devices:
        device.use = device.type == kind
    return f"{' and '.join(dict.fromkeys(names))} by {_NAMES[kind]}"


def follow_preferences(wanted: str, scene: bpy.types.Scene) -> None:
    """Set the device of a scene in an artist's Blender, within its preferences; CPU by default."""
    scene.cycles.device = "CPU" if wanted == "cpu" else "GPU"


def _preferences() -> bpy.types.AddonPreferences | None:
    """Return the preferences of Cycles; None if it is disabled."""
    addon = bpy.context.preferences.addons.get("cycles")
    return addon.preferences if addon else None


def _gpus() -> tuple[str, list[str]]:
    """Find the first device type with GPUs, and return it with their names."""
    preferences = _preferences()
    if preferences is None:
        return "NONE", []
    known = {entry[0] for entry in preferences.get_device_types(bpy.context)}
    for kind in KINDS:
        if kind in known:
            names = [d.name for d in preferences.get_devices_for_type(kind) or () if d.type == kind]
            if names:
                return kind, names
    return "NONE", []
