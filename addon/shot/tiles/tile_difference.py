"""Height difference between the ground of 3D Tiles and the terrain of a scene: shows a wrong geoid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run

from ..terrain import elevation
from ..terrain.tile_heights import TileHeights

if TYPE_CHECKING:
    from ..settings import Settings

MOST = 3.0
"""m, median beyond which the user is warned."""
_PARTS = (5.0, 50.0, 95.0)

Difference = tuple[float, float, float]


def measure(tiles: TileHeights, settings: Settings, run: Run) -> Difference | None:
    """Compute the 5th, 50th, 95th percentile of tiles' ground above the scene's, m; None without overlap.

    The scene's ground is the run's, or the elevation model's, at the points of the fuel grid.
    """
    off = tiles.on_grid(run.fuel_latitude, run.fuel_longitude)[0] - elevation.resolve(settings, run).fuel
    off = off[np.isfinite(off)]
    if not len(off):
        return None
    low, median, high = np.percentile(off, _PARTS).tolist()
    return low, median, high


def sentence(difference: Difference | None, undulation: float | None) -> str:
    """Describe a difference for the user.

    Parameters
    ----------
    undulation
        Height of the geoid that was applied, m; None for a run of heights above the ellipsoid.
    """
    if difference is None:
        return "tiles and the run do not overlap, so their heights could not be compared"
    low, median, high = (round(each, 1) + 0.0 for each in difference)
    said = (
        f"the tiles' ground is {abs(median):.1f} m {'below' if median < 0.0 else 'above'} the scene's own "
        f"(median; {low:.1f} to {high:.1f} m in 90 % of places)"
    )
    if abs(difference[1]) <= MOST:
        return said
    if undulation is None:
        return (
            f"{said}: check `vertical` in run.toml, which says that the run's heights are above the ellipsoid"
        )
    return f"{said}: if the geoid's height is wrong, write tiles.geoid = {undulation + difference[1]:.1f}"
