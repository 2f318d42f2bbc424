"""Thermal pass: band radiance and brightness temperature of a long-wave (or mid-wave) infrared camera.

All surfaces emit Planck radiance by temperature and emissivity. A pixel averages radiance over its area, as a
detector does: half 300 K and half 1200 K give about 840 K. Air and smoke attenuate and emit. The lamps that
light ground and trees in place of the flames are left out.

The EXR has two channels, `radiance` (W m-2 sr-1) and `kelvin`, the brightness temperature, both as measured
by [thermal]'s detector; and `signal`, its counts, if it has a bit depth. The PNG shows temperatures in a
palette, spread towards the cold end, with a colour bar.

The palette begins at the coldest of level ground and air at that time (a tenth of the air is colder; see
`air_temperature.coldest_ground`). By day it is the air; by night it is stone, which has cooled below the air
and reflects the sky. It depends on run, time and band only. So relief shows alike in nights and noons of one
film, and no flare-up or new object changes the colours. `thermal_low` fixes it, for colours that must not
change over time.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from . import RenderedPass

if TYPE_CHECKING:
    from ..shot import Shot

KNEE = 5.0  # K, above which the palette is logarithmic, so that cold ground shows its relief


def finish(
    files: Mapping[str, Path], _needed: Mapping[str, Mapping[str, Path]], shot: Shot, camera: str, frame: int
) -> None:
    """Apply the detector model to the radiance, and write its measurement and the picture."""
    import numpy as np
    from firetwin_core import sensor

    from ...imaging import colour_bar
    from ..settings.settings import BANDS

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
    about = {"Comment": f"kelvin: brightness temperature; radiance: W m-2 sr-1, {low_um:g} to {high_um:g} um"}
    sensor.write_image(files["exr"], np.stack(list(channels.values()), axis=-1), about, list(channels))
    low, high = scale(shot, frame)
    shown = sensor.colour(channels["kelvin"], low, high, settings.palette, KNEE)
    colour_bar.draw(shown, low, high, settings.palette, KNEE)
    sensor.write_image(files["png"], shown)


def scale(shot: Shot, frame: int) -> tuple[float, float]:
    """Temperatures (K) at the cold and the hot end of the palette in a frame."""
    from ..fire import air_temperature
    from ..settings.settings import BANDS

    low, high = shot.settings.render.thermal_low, shot.settings.render.thermal_high
    if low is None:
        band = BANDS[shot.settings.thermal.band]
        low = min(air_temperature.coldest_ground(shot.run, shot.frames.time(frame), band), high - 1.0)
    return low, high


PASS = RenderedPass(
    name="thermal",
    order=30,
    help="Infrared radiance and brightness temperature, 32-bit EXR, and a PNG in palette colours",
    files=("exr", "png"),
    excludes=("lamps",),
    samples=4,
    through_smoke=True,
    film=True,
    aspects=frozenset(
        {
            "time",
            "camera",
            "picture",
            "terrain",
            "forest",
            "fire",
            "smoke",
            "light",
            "grain",
            "thermal",
            "stations",
        }
    ),
    finish=finish,
)
