"""Satellite imager pass in the mid-wave infrared (MWIR, 3.9 um), labelled (see `render.finish._imager`)."""

from __future__ import annotations

from ._band import band

PASS = band("imager_short", 50, "Brightness temperature of a satellite imager, MWIR (3.9 µm)")
