"""Render devices of Cycles: CPU, or GPU by OptiX, CUDA, HIP, oneAPI or Metal."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

KINDS = ("OPTIX", "CUDA", "HIP", "ONEAPI", "METAL")  # ordered by speed
NAMES = {"OPTIX": "OptiX", "CUDA": "CUDA", "HIP": "HIP", "ONEAPI": "oneAPI", "METAL": "Metal"}


@dataclass(frozen=True)
class Gpus:
    """GPUs that Cycles finds, and the interface for them (of `KINDS`)."""

    kind: str
    names: tuple[str, ...]

    def __str__(self) -> str:
        return f"{' and '.join(dict.fromkeys(self.names))} by {NAMES[self.kind]}"


def find_gpus() -> Gpus | None:
    """Find the GPUs of the first interface that has any."""
    preferences = _preferences()
    if preferences is None:
        return None
    known = {entry[0] for entry in preferences.get_device_types(bpy.context)}
    for kind in KINDS:
        if kind in known:
            names = [d.name for d in preferences.get_devices_for_type(kind) or () if d.type == kind]
            if names:
                return Gpus(kind, tuple(names))
    return None


def use(gpus: Gpus | None, scene: bpy.types.Scene) -> None:
    """Set the device of a scene, in a separate Blender process; None: the processor.

    It changes Blender's preferences, so it must not run in an artist's Blender: see `follow_preferences`.
    """
    scene.cycles.device = "CPU" if gpus is None else "GPU"
    preferences = _preferences()
    if gpus is not None and preferences is not None:
        preferences.compute_device_type = gpus.kind
        for device in preferences.devices:
            device.use = device.type == gpus.kind


def follow_preferences(wanted: str, scene: bpy.types.Scene) -> None:
    """Set the device of a scene in an artist's Blender, within its preferences; CPU by default."""
    scene.cycles.device = "CPU" if wanted == "cpu" else "GPU"


def _preferences() -> bpy.types.AddonPreferences | None:
    """Return the preferences of Cycles; None if it is disabled."""
    addon = bpy.context.preferences.addons.get("cycles")
    return addon.preferences if addon else None
