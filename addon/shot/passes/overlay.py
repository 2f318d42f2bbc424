"""Overlay pass: infrared hot spots above 350 K over the visible picture, opaque above 450 K.

Sunlit ground stays below, and ground that burned minutes ago shows faintly (`air_temperature.cooling`).
The two temperatures are chosen by eye. The palette resembles ironbow, on the scale of the thermal picture.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="overlay",
    order=45,
    help="Visible picture overlaid with the hot spots of the thermal pass",
    files=("png",),
    film=True,
    needs=("rgb", "thermal"),
)
