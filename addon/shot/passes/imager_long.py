"""What a satellite's imager measures in the thermal infrared (11.2 um), labelled (see `_imager`)."""

from __future__ import annotations

from ._band import band

PASS = band(
    "imager_long", 51, "What a satellite's imager measures in the thermal infrared (11.2 µm)", long=True
)
