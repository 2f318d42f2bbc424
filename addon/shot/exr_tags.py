"""Header attributes of EXR files, and the colour space of their radiance. Needs no Blender.

Names and types are OpenEXR's standard attributes (`ImfStandardAttributes.h`), except `EXPOSURE` and
`ORIGIN`. `colorInteropID` follows the ASWF Color Interop recommendation "Identifying the Color Space of
OpenEXR Files". Attributes depend on shot
and frame alone, so equal pictures are equal files.
"""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

import firetwin_core
import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .. import timecode
from . import picture_credits
from .cameras import path, pixel_rays
from .shot import Shot

COLOUR_IDS = {"rec709": "lin_rec709_scene", "acescg": "lin_ap1_scene"}
"""Color Interop identifiers by `render.exr_space`."""

AP1_FROM_REC709 = np.array(
    [
        [0.613097, 0.339523, 0.047379],
        [0.070194, 0.916354, 0.013452],
        [0.020616, 0.109570, 0.869815],
    ]
)
"""Linear Rec.709 (D65) to AP1 (D60) with Bradford adaptation, as in OpenColorIO's ACES configurations."""

TIMES = ("capDate", "framesPerSecond", "timeCode", "utcOffset")
"""Attributes that `times` returns."""

EXPOSURE, ORIGIN = "exposureStops", "worldOrigin"
"""Our own attributes: exposure, stops; and latitude, longitude and height (m) of the scene's origin."""

_MOST_COUNTED = 30  # frames per second that timecode counts; faster films count pairs


def attributes(
    shot: Shot, camera: str, frame: int, comments: str = "", stops: float | None = None
) -> dict[str, Any]:
    """Collect the attributes of a frame's EXR for `sensor.write_image`.

    Parameters
    ----------
    camera
        Name of the camera's view.
    comments
        Meaning of the channels.
    stops
        Exposure of the picture, for a file of scene-linear radiance in `render.exr_space`; None: it is data.
    """
    view = pixel_rays.path_of(shot.paths, camera)
    run = f"Firetwin: {shot.run.name}" + (" (synthetic)" if shot.run.synthetic else "")
    latitude, longitude, altitude = (
        float(value[0]) for value in shot.local_frame.reverse(view.position[frame - 1][None])
    )
    owner, origin = "; ".join(picture_credits.of_shot(shot).data), shot.local_frame
    space = COLOUR_IDS[shot.settings.render.exr_space]
    return {
        **({"colorInteropID": "data"} if stops is None else {"colorInteropID": space, EXPOSURE: stops}),
        "comments": f"{run}; {comments}" if comments else run,
        "Software": f"Firetwin {firetwin_core.__version__}",
        "cameraLabel": camera,
        "latitude": latitude,
        "longitude": longitude,
        "altitude": altitude,
        ORIGIN: f"{origin.latitude} {origin.longitude} {origin.height}",  # floats have too few digits
        "imageCounter": frame,
        **({"owner": owner} if owner else {}),
        **times(shot, frame),
        **_lens(view, frame),
    }


def times(shot: Shot, frame: int) -> dict[str, Any]:
    """Collect the attributes with model time and film time, which depend on frame rate and time zone."""
    local = shot.utc(frame).astimezone(ZoneInfo(shot.settings.time.zone))
    offset = local.utcoffset()
    assert offset is not None  # it has a time zone
    return {
        "capDate": f"{local:%Y:%m:%d %H:%M:%S}",
        "utcOffset": 0.0 - offset.total_seconds(),  # OpenEXR: UTC == local time + utcOffset
        **film_time(shot.settings.time.rate, frame),
    }


def film_time(rate: Fraction, frame: int) -> dict[str, Any]:
    """Compute frame rate and timecode of a frame, from 1, as the timecode track of films has them.

    Timecode counts up to 30 frames in a second (SMPTE ST 12-1): at higher rates it counts pairs, and the
    field mark is set in the second frame of a pair. Rates over 60 have no timecode.
    """
    nominal = timecode.nominal_rate(rate)
    if nominal > 2 * _MOST_COUNTED:
        return {"framesPerSecond": rate}
    hours, minutes, seconds, number = timecode.components(timecode.count_of_frame(frame, rate), rate)
    pairs = nominal > _MOST_COUNTED
    code = sensor.TimeCode(
        hours,
        minutes,
        seconds,
        number // 2 if pairs else number,
        drop_frame=timecode.is_drop_frame(rate),
        second_field=pairs and number % 2 == 1,
    )
    return {"framesPerSecond": rate, "timeCode": code}


def world_to_camera(view: path.Path, frame: int) -> NDArray[np.float64]:
    """Return the matrix (4, 4), for row vectors, from the scene to OpenEXR's camera: right, up, ahead."""
    axes = view.rotation[frame - 1] * np.array([1.0, 1.0, -1.0])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[3, :3] = axes, -view.position[frame - 1] @ axes
    return matrix


def world_to_ndc(view: path.Path, frame: int) -> NDArray[np.float64]:
    """Return the matrix (4, 4), for row vectors, from the scene to the picture.

    The picture has (0, 0) at the top left and (1, 1) at the bottom right. Its
    third coordinate is 1 - 1 m / depth in perspective, and depth in m otherwise.
    """
    across, up = view.halves[frame - 1]
    picture = np.diag([0.5 / across, -0.5 / up, 1.0, 0.0])
    row = 2 if view.perspective else 3
    picture[row, :2], picture[row, 3] = 0.5, 1.0
    if view.perspective:
        picture[3, 2] = -1.0
    return world_to_camera(view, frame) @ picture


def _lens(view: path.Path, frame: int) -> dict[str, Any]:
    """Collect matrices and lens; a panorama has neither a picture plane nor a focal length."""
    tags: dict[str, Any] = {"worldToCamera": world_to_camera(view, frame)}
    if not view.around:
        tags["worldToNDC"] = world_to_ndc(view, frame)
    if view.perspective and not view.around:
        across, up = view.halves[frame - 1]
        tags["pinholeFocalLength"] = 0.5 * view.sensor / float(across)
        tags["sensorOverallDimensions"] = (view.sensor, view.sensor * float(up / across))
    return tags


def to_exr_space(light: NDArray[np.float32], space: str) -> NDArray[np.float32]:
    """Convert radiance (h, w, 3) from linear Rec.709 to a value of `render.exr_space`."""
    if space == "rec709":
        return light
    return (light @ AP1_FROM_REC709.T).astype(np.float32)


def write_radiance(
    file: Path, light: NDArray[np.float32], shot: Shot, camera: str, frame: int, stops: float
) -> None:
    """Write radiance (h, w, 3), linear Rec.709, as 16-bit EXR in `render.exr_space`; `stops`: see above."""
    about = attributes(shot, camera, frame, "scene-linear radiance", stops)
    sensor.write_image(file, to_exr_space(light, shot.settings.render.exr_space), about, half=True)
