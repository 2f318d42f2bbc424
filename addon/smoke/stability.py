"""Atmospheric stability by day and by night."""

from __future__ import annotations

from ..shot.terrain import noise

DAY = 8.0e-6  # 1/s2, squared buoyancy frequency of a deep mixed layer (assumed)
NIGHT = 4.0e-4  # 1/s2, of a valley inversion: about 12 K/km of potential temperature (assumed)
MERGE = 5000.0  # m, distance within which plumes merge (assumed: about the plume's own height)
TURN = (-10.0, 2.0)  # degrees, solar elevations between which night turns into day


def at_elevation(height: float) -> float:
    """Return the squared buoyancy frequency (1/s2) for the sun's elevation `height` (degrees).

    Its logarithm is interpolated smoothly between night and day, so that smoke changes continuously.
    """
    day = float(noise.smoothstep(*TURN, height))
    return float(NIGHT * (DAY / NIGHT) ** day)
