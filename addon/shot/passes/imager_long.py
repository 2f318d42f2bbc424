"""Satellite imager pass in the long-wave infrared (LWIR, 11.2 um), labelled (see `render.finish._imager`)."""

from __future__ import annotations

from ._band import band

PASS = band("imager_long", 51, "Brightness temperature of a satellite imager, LWIR (11.2 µm)")
