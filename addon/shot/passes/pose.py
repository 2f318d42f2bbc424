"""A sidecar of each frame for machines: where the camera is, how it projects, when, and in which units.

`camera_to_world` takes points of the camera (x right, y up, z backwards: OpenGL's, Blender's and nerfstudio's
axes) to metres east, north and up of `origin`, the WGS84 place in whose tangent plane the scene lies. Pixels
count from the upper left corner of the picture, u to the right and v down, the middle of the first at (0.5,
0.5). A point (x, y, z) of the camera is seen at u = cx + fx x / d and v = cy - fy y / d, where d = -z is its
planar depth; in a parallel projection d is left out, and fx and fy are pixels per metre. Lenses distort
nothing. The camera in Blender is within 0.05 pixels of it. `files` are those of the camera's passes in the
scene file, as seen from the sidecar.

Where a camera sees all round, the picture of the left eye, `eye` pixels high, lies above the right one's. An
eye sees the direction (x, y, z) at u = cx + fx atan2(x, -z) and v = cy - fy asin(y) of its picture; fx and fy
are pixels per radian, and the eyes are `interocular` metres apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import DerivedPass, Files, file_of, of_camera

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..cameras.path import Path
    from ..shot import Shot

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
    """Write what is known of the camera in this frame."""
    import json

    from ..cameras import pixel_rays

    text = json.dumps(described(shot, pixel_rays.path_of(shot, camera), frame), indent=1) + "\n"
    files["json"].write_text(text, encoding="utf-8")


def described(shot: Shot, view: Path, frame: int) -> dict[str, Any]:
    """All of a sidecar."""
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
            each.name: {end: f"../../{file_of(camera.name, each.name, frame, end)}" for end in each.files}
            for each in of_camera(shot.settings, camera)
            if each is not PASS
        },
    }


def pose(shot: Shot, view: Path, frame: int) -> dict[str, Any]:
    """Place and direction; heights count from the datum of the run's elevations."""
    import numpy as np

    from ..cameras import path

    here, turn, frame_of = view.position[frame - 1], view.rotation[frame - 1], shot.local_frame
    latitude, longitude, height = (float(value[0]) for value in frame_of.reverse(here[None]))
    east, north, up = path.compass(frame_of, here)
    right, above, ahead = turn[:, 0], turn[:, 1], -turn[:, 2]
    level = ahead if abs(ahead @ up) < 0.9999 else above  # straight down its upper edge points somewhere
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
    """How it projects."""
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


PASS = DerivedPass(
    name="pose",
    order=5,
    help="Camera position, orientation, lens, time and units of each frame, JSON",
    files=("json",),
    aspects=frozenset({"time", "camera", "picture", "terrain", "passes"}),
    finish=finish,
)
