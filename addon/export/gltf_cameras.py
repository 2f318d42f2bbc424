"""glTF cameras: a node with a lens for each camera of the shot, and an animation for each that tracks.

An animation begins with the first exported frame at 0 s. glTF has no angle of view that changes: the lens
is the lens of the first frame, and the node's extras have the angles of all frames (`yfov`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..geometry.camera_track import CameraTrack
from ..geometry.quaternion import quaternions
from ..tiles.make import glb
from .gltf_document import TO_Y_UP, Document
from .scene_content import Array, SceneContent

_PANORAMA = 0.5 * np.pi  # angle of view that stands for a panorama, which glTF does not have


def add(document: Document, content: SceneContent) -> None:
    """Append all cameras."""
    if not content.cameras:
        return
    parent = document.node("cameras")
    for track in content.cameras:
        _add(document, parent, track, content.rate)


def _add(document: Document, parent: int, track: CameraTrack, rate: float) -> None:
    position = glb.y_up(track.position)
    rotation = np.roll(quaternions(TO_Y_UP @ track.rotation), -1, axis=1)  # x, y, z, w
    yfov = angles(track)
    extras: dict[str, Any] = {"projection": track.projection, "frames": track.frames.tolist()}
    if yfov is not None and np.ptp(yfov) > 0.0:
        extras["yfov"] = yfov.tolist()
    node = document.node(
        track.name,
        parent,
        camera=document.add("cameras", {"name": track.name} | _lens(track, yfov)),
        translation=position[0].tolist(),
        rotation=rotation[0].tolist(),
        extras=extras,
    )
    if len(track.frames) > 1 and (np.ptp(position, axis=0).any() or np.ptp(rotation, axis=0).any()):
        _animate(document, node, track, (position, rotation), rate)


def _animate(
    document: Document, node: int, track: CameraTrack, pose: tuple[Array, Array], rate: float
) -> None:
    times = document.scalars((track.frames - track.frames[0]) / rate, bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for path, values in zip(("translation", "rotation"), pose, strict=True):
        output = document.buffer.accessor(values, glb.FLOAT, f"VEC{values.shape[1]}")
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
    document.add("animations", {"name": track.name, "channels": channels, "samplers": samplers})


def angles(track: CameraTrack) -> Array | None:
    """Return the vertical angles of view (f,), radians; None for an orthographic camera."""
    if track.projection == "orthographic":
        return None
    if track.projection == "panorama":
        return np.full(len(track.frames), _PANORAMA)
    return 2.0 * np.arctan(track.half[:, 1])


def _lens(track: CameraTrack, yfov: Array | None) -> dict[str, Any]:
    near, far = (float(plane) for plane in track.clip[0])
    if yfov is None:
        width, height = track.half[0].tolist()
        box = {"xmag": width, "ymag": height, "znear": near, "zfar": far}
        return {"type": "orthographic", "orthographic": box}
    aspect = 1.0 if track.projection == "panorama" else 1.0 / track.aspect
    lens = {"aspectRatio": aspect, "yfov": float(yfov[0]), "znear": near, "zfar": far}
    return {"type": "perspective", "perspective": lens}
