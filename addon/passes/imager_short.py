"""Satellite imager pass in the mid-wave infrared (MWIR, 3.9 um), labelled (see `passes._imager`)."""

from __future__ import annotations

import functools

from . import _imager

ORDER = 50
HELP = "Brightness temperature, MWIR: ABI band 7 (3.9 µm) or VIIRS band I4 (3.74 µm)"

PASS = _imager.PASS
finish = functools.partial(_imager.finish, long=False)
