"""Satellite imager pass in the long-wave infrared (LWIR), labelled (see `render.finish._imager`).

It simulates ABI band 14 (11.2 um) for a geostationary satellite, otherwise VIIRS band I5 (11.45 um).
"""

from __future__ import annotations

from ._band import band

PASS = band(
    "imager_long", 51, "Brightness temperature, LWIR: ABI band 14 (11.2 µm) or VIIRS band I5 (11.45 µm)"
)
