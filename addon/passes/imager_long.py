"""Satellite imager pass in the long-wave infrared (LWIR), labelled (see `passes._imager`).

It simulates ABI band 14 (11.2 um) for a geostationary satellite, otherwise VIIRS band I5 (11.45 um).
"""

from __future__ import annotations

import functools

from . import _imager

ORDER = 51
HELP = "Brightness temperature, LWIR: ABI band 14 (11.2 µm) or VIIRS band I5 (11.45 µm)"

PASS = _imager.PASS
finish = functools.partial(_imager.finish, long=True)
