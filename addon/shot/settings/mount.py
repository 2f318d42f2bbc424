"""Sensor mounts: which camera supplies each input of a composite pass, such as the fused view.

A camera's own recording comes first. Any other input comes from the first sensor on its mount that
records it. A map comes from the first minimap that follows the camera and records the visible picture. Any
other input is rendered for the camera. A sensor supplies nothing if it films other frames than the camera.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .. import passes
from ..cameras.rigs.minimap import Minimap
from ..cameras.rigs.mounted import Mounted

if TYPE_CHECKING:
    from . import Camera, Settings

MAP = "map"


def taken(
    settings: Settings, cameras: Sequence[Camera], name: str, derived: passes.Pass
) -> dict[str, tuple[str, str]]:
    """Camera and pass that supply each input of a pass of the camera `name`.

    Parameters
    ----------
    cameras
        All cameras of the scene file.
    """
    if not isinstance(derived, passes.DerivedPass):
        return {}
    suppliers = {need: (name, need) for need in derived.needs}
    if not derived.mount:
        return suppliers
    (camera,) = (each for each in cameras if each.name == name)
    own = _records(settings, camera)
    for other in cameras:
        if other.rig.followed(cameras) is not camera or other.frames not in ("", camera.frames):
            continue
        records = _records(settings, other)
        if isinstance(other.rig, Mounted):
            free = (need for need in derived.needs if need in records - own and suppliers[need][0] == name)
            suppliers |= {need: (other.name, need) for need in free}
        elif isinstance(other.rig, Minimap) and "rgb" in records:
            suppliers.setdefault(MAP, (other.name, "rgb"))
    return suppliers


def _records(settings: Settings, camera: Camera) -> set[str]:
    return {made.name for made in passes.of_camera(settings, camera)}
