"""What a long-wave (or mid-wave) infrared camera measures: radiance of the band and brightness temperature.

Everything gives off Planck's radiance by its temperature and emissivity; a pixel is the mean of the radiance
over itself, as in a detector: half 300 K and half 1200 K is about 840 K. Air and smoke dim what is behind
them and add their own light. The lamps that light ground and trees in place of the flames are left out.

The EXR holds two channels, `radiance` (W m-2 sr-1) and `kelvin`, the temperature of a black body as bright,
both as [thermal]'s detector measures them; and `signal`, its counts, where it has bits. The PNG shows the
temperatures by a palette, spread towards the cold end, with a bar of temperatures.

The palette begins at the coldest that level ground or air is at the moment (a tenth of the air is colder; see
`air_temperature.coldest_ground`): by day the air, by night stone, which has cooled below it and mirrors the
sky.
That hangs on the run, the time and the band alone: nights and noons of one film show their relief alike, and
nothing that comes into view or flares up changes the colours. `thermal_low` holds it in one place, where
colours are to mean the same all through.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from . import RenderedPass

if TYPE_CHECKING:
    from ..shot import Shot

KNEE = 5.0  # K; the palette's scale is logarithmic above this, so that cold ground shows its relief


def finish(
    files: Mapping[str, Path], _needed: Mapping[str, Mapping[str, Path]], shot: Shot, camera: str, frame: int
) -> None:
    """Let the detector measure the radiance, write what it found, and the picture."""
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
    from .. import air_temperature
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
        {"time", "camera", "picture", "terrain", "forest", "fire", "smoke", "light", "grain", "thermal"}
    ),
    finish=finish,
)
