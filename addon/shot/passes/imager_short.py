"""Satellite imager pass in the mid-wave infrared (MWIR, 3.9 um), labelled (see `render.finish._imager`)."""

from __future__ import annotations

from ._band import band

PASS = band(
    "imager_short", 50, "Brightness temperature, MWIR: ABI band 7 (3.9 µm) or VIIRS band I4 (3.74 µm)"
)
