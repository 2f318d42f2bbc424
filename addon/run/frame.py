"""Local scene frame: Blender's x, y, z are east, north, up in metres."""

from __future__ import annotations

from firetwin_core import geo
from firetwin_core.run import Run


def local_frame(run: Run) -> geo.LocalFrame:
    """Create the frame whose origin is the centre of the run's model grid, at height 0.

    z is not height above sea level away from the origin: the Earth's curvature is in it (-50 m at 25 km).
    """
    latitude, longitude = run.latitude, run.longitude
    return geo.LocalFrame((latitude[0] + latitude[-1]) / 2, (longitude[0] + longitude[-1]) / 2, 0.0)
