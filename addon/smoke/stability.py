"""The air that smoke rises into: how stable it is, by day and by night."""

from __future__ import annotations

from ..shot.terrain import noise

DAY = 8.0e-6  # 1/s2, square of the buoyancy frequency: a deep mixed layer (assumed)
NIGHT = 4.0e-4  # 1/s2: about 12 K/km of potential temperature, a valley's inversion (assumed)
MERGE = 5000.0  # m; fires this near each other rise as one plume (assumed: about the plume's own height)
TURN = (-10.0, 2.0)  # degrees of the sun's height between which night turns to day


def under(height: float) -> float:
    """Square of the buoyancy frequency (1/s2) under a sun at `height` degrees over the horizon.

    Between night and day its logarithm changes smoothly, so smoke sinks and rises without a jump.
    """
    day = float(noise.smoothstep(*TURN, height))
    return float(NIGHT * (DAY / NIGHT) ** day)
