"""Pose pass: sidecar of each frame with extrinsics, intrinsics, time and units, for machines.

`camera_to_world` maps camera coordinates (x right, y up, z backwards: the axes of OpenGL, Blender and
nerfstudio) to metres east, north and up of `origin`, the WGS84 point of the scene's tangent plane. Pixel
coordinates count from the picture's upper left corner, u to the right and v down; the first pixel's centre is
(0.5, 0.5). A camera point (x, y, z) projects to u = cx + fx x / d and v = cy - fy y / d, where d = -z is its
planar depth. In an orthographic projection u and v do not depend on d, and fx and fy are pixels per metre.
Lenses are free of distortion. The camera in Blender agrees within 0.05 pixels. `files` are the files of the
camera's other passes, relative to the sidecar. `credits` and `services` are the credits that the picture
needs. `tiles`, if 3D Tiles are shown, has missing tiles and the screen-space error of the selection, pixels.

In a panorama the left eye's picture, `eye` pixels high, is above the right eye's. A direction (x, y, z)
projects to u = cx + fx atan2(x, -z) and v = cy - fy asin(y) in each eye's picture; fx and fy are pixels per
radian, and the eyes are `interocular` metres apart.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..shot import picture_credits
from ..shot.cameras import path, pixel_rays
from ..shot.cameras.path import Path
from ..shot.passes import DerivedPass, Files, file_of, of_camera
from ..shot.shot import Shot
from ..shot.tiles import tile_cut

ORDER = 5
HELP = "Camera position, orientation, lens, time and units of each frame, JSON"

PASS = DerivedPass(
    files=("json",),
    aspects=frozenset({"time", "camera", "picture", "terrain", "sidecar"}),
)

UNITS = {
    "position": "m",
    "angles": "degrees",
    "pixels": "pixels",
    "time": "s since the run began",
    "depth": "m",
    "kelvin": "K",
    "radiance": "W m-2 sr-1",
}


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Write the sidecar of a frame."""
    text = json.dumps(describe(shot, pixel_rays.path_of(shot.paths, camera), frame), indent=1) + "\n"
    files["json"].write_text(text, encoding="utf-8", newline="\n")


def describe(shot: Shot, view: Path, frame: int) -> dict[str, Any]:
    """Make the content of a sidecar."""
    run, camera = shot.run, view.camera
    return {
        "format": "firetwin pose 1",
        "camera": camera.name,
        "kind": camera.kind,
        "frame": frame,
        "run": run.name,
        "synthetic": run.synthetic,
        "time_utc": shot.utc(frame).isoformat(timespec="milliseconds"),
        "model_time": shot.frames.time(frame),
        "units": UNITS,
        "pose": pose(shot, view, frame),
        "intrinsics": intrinsics(view, frame, *shot.resolution(camera)),
        "files": {
            recorded.name: {
                end: f"../../{file_of(camera.name, recorded.name, frame, end)}" for end in recorded.files
            }
            for recorded in of_camera(shot.settings, camera)
            if recorded.name != "pose"
        },
        **_credits(shot),
        **_tiles(shot),
    }


def _credits(shot: Shot) -> dict[str, Any]:
    """Collect the credits of the frame and the names of tile services."""
    words = picture_credits.of_shot(shot)
    found = {"credits": list(words.data), "services": list(words.logo)}
    return {name: values for name, values in found.items() if values}


def _tiles(shot: Shot) -> dict[str, Any]:
    """Collect the missing tiles of the frame and the screen-space error, pixels."""
    cut = tile_cut.prepared(shot)
    return {"tiles": {"missing": list(cut.missing), "error": cut.error}} if cut else {}


def pose(shot: Shot, view: Path, frame: int) -> dict[str, Any]:
    """Compute position and orientation; heights refer to the datum of the run's elevations."""
    here, turn, frame_of = view.position[frame - 1], view.rotation[frame - 1], shot.local_frame
    latitude, longitude, height = (float(value[0]) for value in frame_of.reverse(here[None]))
    east, north, up = path.compass(frame_of, here)
    right, above, ahead = turn[:, 0], turn[:, 1], -turn[:, 2]
    # for a camera looking straight down, the upper edge of the picture defines the heading
    level = ahead if abs(ahead @ up) < 0.9999 else above
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, here
    return {
        "latitude": latitude,
        "longitude": longitude,
        "height": height,
        "vertical": shot.run.vertical,
        "height_above_ground": float(here[2] - shot.ground.up(here[0], here[1])[0]),
        "heading": float(np.degrees(np.arctan2(level @ east, level @ north)) % 360.0),
        "pitch": float(np.degrees(np.arcsin(np.clip(ahead @ up, -1.0, 1.0)))),
        "roll": 0.0 if level is above else float(np.degrees(np.arctan2(-(right @ up), above @ up))),
        "origin": {"latitude": frame_of.latitude, "longitude": frame_of.longitude, "height": frame_of.height},
        "camera_to_world": matrix.tolist(),
    }


def intrinsics(view: Path, frame: int, width: int, height: int) -> dict[str, Any]:
    """Compute the camera intrinsics."""
    across, up = view.halves[frame - 1] / (view.meet or 1.0)
    eye = height // 2 if view.around else height
    flat = "perspective" if view.perspective or view.meet else "parallel"
    return {
        "projection": "equirectangular" if view.around else flat,
        "width": width,
        "height": height,
        **({"eye": eye, "interocular": view.apart} if view.around else {}),
        "fx": 0.5 * width / float(across),
        "fy": 0.5 * eye / float(up),
        "cx": 0.5 * width,
        "cy": 0.5 * eye,
        "distortion": {"model": "none", **dict.fromkeys(("k1", "k2", "k3", "p1", "p2"), 0.0)},
    }
