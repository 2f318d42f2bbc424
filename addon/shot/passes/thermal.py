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

from . import RenderedPass

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
    finished=True,
)
