"""Thermal pass: band radiance and brightness temperature of an infrared camera, LWIR or MWIR.

All surfaces emit Planck radiance by temperature and emissivity. A pixel averages radiance over its area, as a
detector does: half 300 K and half 1200 K give about 840 K. Air and smoke attenuate and emit. The point lights
that light terrain and trees in place of the flames are excluded.

The EXR has two channels, `radiance` (W m-2 sr-1) and `kelvin`, the brightness temperature, both as the
detector of [thermal] measures them; and `signal`, its counts, if it has a bit depth. The PNG shows
temperatures in a palette, spread towards the cold end, with a colour bar. Its darkest 15 % show 45 K below
the lower limit: the sky, which is colder towards the zenith, and smoke before it.

The palette's lower limit is the lowest temperature of level ground and air at that time (see
`air_temperature.coldest_ground`; the air value is the 10th percentile). By day it is the air; by night it
is stone, which has cooled below the air and reflects the sky. It depends on run, time and band only. Relief
therefore has the same contrast by night and at noon, and no flare-up or new object changes the colours.
`thermal_low` fixes it as the end of the palette, for colours that must not change over time.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..imaging import colour_bar
from ..shot import exr_tags
from ..shot.fire import air_temperature
from ..shot.passes import SURFACES, Files, RenderedPass
from ..shot.sections.thermal import BANDS
from ..shot.shot import Shot

ORDER = 30
HELP = "Infrared radiance and brightness temperature, 32-bit EXR, and a PNG in palette colours"

PASS = RenderedPass(
    files=("exr", "png"),
    excludes=("lamps",),
    samples=4,
    through_smoke=True,
    shares_rays=True,
    film=True,
    aspects=SURFACES | {"fire", "smoke", "light", "grain", "thermal"},
)

_COLD = 45.0  # K below the coldest ground at which the palette ends, for the sky (by eye)
KNEE = 10.0  # K above the lower limit, from which the palette is logarithmic: relief of cold ground is seen


def march(eye: Any, frame: int) -> NDArray:
    """Return the radiance (h, w), W m-2 sr-1."""
    return eye.radiance(frame)


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
