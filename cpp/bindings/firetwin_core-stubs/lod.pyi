"""Visibility of a shot: level of detail, frustum culling and occlusion culling."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def levels(distance: ArrayLike) -> NDArray[np.uint8]:
    """Level of detail of each distance (m): 0 up to 1500, 1 up to 3500, else (and for NaN) 2."""

class LevelTable:
    """Level of detail by distance: level i ends at thresholds[i] (m, included); one more level follows."""

    def __init__(
        self, thresholds: Sequence[float] = (1500.0, 3500.0), multipliers: Sequence[float] = (1.0, 0.7, 0.4)
    ) -> None: ...
    @property
    def thresholds(self) -> list[float]:
        """m, ascending."""
    @property
    def multipliers(self) -> list[float]:
        """Particle multiplier of each level: one more than thresholds."""
    def levels(self, distance: ArrayLike) -> NDArray[np.uint8]:
        """Level of each distance (m), of the same shape; NaN has the last level."""
    def multiplier(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Particle multiplier of each distance (m), of the same shape."""

def select_nearest(position: ArrayLike, camera: ArrayLike, budget: int) -> NDArray[np.int64]:
    """Distance budget: indices of the `budget` positions (n, 3) nearest to any camera (m, 3).

    The order is nearest first, ties by index.
    """

class Occluder:
    """Terrain as an occluder for occlusion culling. It keeps a lower bound of a continuous surface."""

    def __init__(self, position: ArrayLike) -> None:
        """Make an occluder of the surface through position (rows, columns, 3) m: triangles join neighbours.

        The bound also holds for finer surfaces that are nowhere below these triangles. Places outside of the
        surface occlude nothing.

        Raises
        ------
        ValueError
            There are fewer than 2 x 2 places, they cover no area, or one is not finite.
        """

class ViewSet:
    """Views of a shot as a tree, for frustum and occlusion culling (see `visible_mask`)."""

    def __init__(
        self,
        camera: ArrayLike,
        rotation: ArrayLike,
        half_extent: ArrayLike,
        sun: ArrayLike = (0.0, 0.0, 0.0),
        orthographic: ArrayLike = False,
        above_terrain: ArrayLike = True,
        occluder: Occluder | None = None,
        lowest_terrain: float = 0.0,
    ) -> None:
        """Make m views. All arguments but `camera` broadcast to m views. Order views along the camera path.

        Parameters
        ----------
        camera
            (m, 3) m.
        rotation
            (m, 3, 3) to world axes; the camera looks along its -z, y is up.
        half_extent
            (m, 2) perspective: tangents of half the horizontal and vertical angle of view. Orthographic: half
            the width and height of the picture, m.
        sun
            (m, 3) unit vectors to the sun. A sun below one degree, or a zero vector, casts no shadows.
        orthographic
            (m,) whether the projection is parallel.
        above_terrain
            (m,) whether the camera is above the terrain. Terrain occludes only for such cameras.
        occluder
            Terrain; None disables occlusion culling.
        lowest_terrain
            Lower bound of all terrain, m. Shadow rays end there.

        Raises
        ------
        ValueError
            A shape does not fit, a number is not finite, `half_extent` is not above 0, or a rotation is not
            orthonormal.
        """

def visible_mask(
    position: ArrayLike,
    radius: ArrayLike,
    views: ViewSet,
    max_distance: float = float("inf"),
    margin: float = 0.0,
    shadows: bool = False,
) -> NDArray[np.bool_]:
    """(n,) visibility of bounding spheres at position (n, 3) with radius (n,) m: frustum and occlusion culling.

    Culling is conservative: a visible sphere is never culled, and a sphere just behind an edge may be kept. A
    sphere with a NaN is never visible. The result is exact for each view. Views are tested as a tree, whose
    branches bound the translation and rotation of their views. Tiles of terrain are tested before the spheres
    in them.

    Parameters
    ----------
    max_distance
        m; a perspective camera does not see spheres beyond it.
    margin
        m by which every frustum is enlarged.
    shadows
        Whether to keep shadow casters: spheres whose shadow falls on a visible place, air or terrain.

    Raises
    ------
    ValueError
        A shape does not fit, or radius, max_distance or margin is below 0.
    """

def distance(position: ArrayLike, views: ViewSet) -> NDArray[np.float64]:
    """(n,) distance of position (n, 3) from the nearest perspective camera, m; infinite without one."""
