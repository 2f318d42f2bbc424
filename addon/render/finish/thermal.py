"""Apply the detector model to rendered radiance, and draw it in palette colours."""

from __future__ import annotations

import zlib
from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor

from ...imaging import colour_bar
from ...shot.fire import air_temperature
from ...shot.sections.thermal import BANDS
from ...shot.shot import Shot
from .. import exr_tags
from . import Files

_COLD = 45.0  # K below the coldest ground at which the palette ends, for the sky (by eye)
KNEE = 10.0  # K above the lower limit, from which the palette is logarithmic: relief of cold ground is seen


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Apply the detector model to the radiance, and write its measurement and the picture."""
    settings = shot.settings.thermal
    table = sensor.PlanckTable(BANDS[settings.band])
    reached = sensor.read_image(files["exr"])[..., 0]
    measured, counts = table.detect(
        reached,
        blur=settings.blur,
        noise=settings.noise,
        saturation=settings.saturation,
        bits=settings.bits,
        key=zlib.crc32(f"{camera} {frame} {shot.settings.render.seed}".encode()),
    )
    channels = {"kelvin": table.brightness_temperature(measured), "radiance": measured}
    if counts is not None:
        channels["signal"] = counts.astype(np.float32)
    low_um, high_um = BANDS[settings.band]
    said = f"kelvin: brightness temperature; radiance: W m-2 sr-1, {low_um:g} to {high_um:g} um"
    about = exr_tags.attributes(shot, camera, frame, said)
    sensor.write_image(files["exr"], np.stack(list(channels.values()), axis=-1), about, list(channels))
    low, high = scale(shot, frame)
    cold = cold_range(shot)
    shown = colour_bar.paint(channels["kelvin"], low, high, settings.palette, KNEE, cold)
    colour_bar.draw(shown, low, high, settings.palette, KNEE, cold)
    sensor.write_image(files["png"], shown)


def scale(shot: Shot, frame: int) -> tuple[float, float]:
    """Return the temperatures (K) at the cold and the hot end of the palette in a frame."""
    low, high = shot.settings.render.thermal_low, shot.settings.render.thermal_high
    if low is None:
        band = BANDS[shot.settings.thermal.band]
        low = min(air_temperature.coldest_ground(shot.run, shot.frames.time(frame), band), high - 1.0)
    return low, high


def cold_range(shot: Shot) -> float:
    """Return the range (K) of the palette below its lower limit, for the sky; 0 if settings fix the limit."""
    return _COLD if shot.settings.render.thermal_low is None else 0.0
