"""Visibility of a shot: level of detail, frustum culling and occlusion culling."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def levels(distance: ArrayLike) -> NDArray[np.uint8]:
    """Return the level of detail at each distance (m): 0 up to 1500, 1 up to 3500, else (and for NaN) 2."""

class LevelTable:
    """Levels of detail by distance: level i ends at thresholds[i] (m, inclusive); one more level follows."""

    def __init__(
        self, thresholds: Sequence[float] = (1500.0, 3500.0), multipliers: Sequence[float] = (1.0, 0.7, 0.4)
    ) -> None: ...
    @property
    def thresholds(self) -> list[float]:
        """Ascending distances, m."""
    @property
    def multipliers(self) -> list[float]:
        """Particle multipliers, one per level."""
    def levels(self, distance: ArrayLike) -> NDArray[np.uint8]:
        """Return the level at each distance (m), in the same shape; NaN gives the last level."""
    def multiplier(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Return the particle multiplier at each distance (m), in the same shape."""

def select_nearest(position: ArrayLike, camera: ArrayLike, budget: int) -> NDArray[np.int64]:
    """Select the `budget` positions (n, 3) nearest to any camera (m, 3).

    Returns their indices, nearest first; ties are ordered by index.
    """

class Occluder:
    """Terrain as an occluder for occlusion culling. It stores a lower bound of a continuous surface."""

    def __init__(self, position: ArrayLike) -> None:
        """Create an occluder from the surface through position (rows, columns, 3), m.

        The bound holds for any triangulation of the grid and for finer surfaces above it. Areas outside the
        surface occlude nothing.

        Raises
        ------
        ValueError
            There are fewer than 2 x 2 points, they cover no area, or one is not finite.
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
        """Create m views, ordered along the camera path. All arguments but `camera` broadcast to m views.

        Parameters
        ----------
        camera
            (m, 3) m.
        rotation
            (m, 3, 3) to world axes; the camera looks along its -z, y is up.
        half_extent
            (m, 2) perspective: tangents of half the horizontal and vertical angle of view. Orthographic: half
            the width and height of the image, m.
        sun
            (m, 3) unit vectors to the sun. A sun below one degree, or a zero vector, casts no shadows.
        orthographic
            (m,) True for a parallel projection.
        above_terrain
            (m,) True if the camera is above the terrain. Terrain occludes only for such cameras.
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
    """Test n bounding spheres for visibility by frustum and occlusion culling.

    Culling is conservative: a visible sphere is never culled, and a sphere just outside an edge may pass.
    A sphere with a NaN is never visible. The result is exact for each view. Views are tested as a tree, whose
    branches bound the translation and rotation of their views. Tiles of terrain are tested before the spheres
    in them.

    Parameters
    ----------
    position, radius
        (n, 3) and (n,), m.
    views
        Views of the shot.
    max_distance
        Range of perspective cameras, m.
    margin
        Enlargement of each frustum, m.
    shadows
        Keep shadow casters: spheres whose shadow falls on a visible point of the air or the terrain.

    Returns
    -------
    visible
        (n,) True if any view sees the sphere.

    Raises
    ------
    ValueError
        A shape does not fit, or radius, max_distance or margin is negative.
    """

def distance(position: ArrayLike, views: ViewSet) -> NDArray[np.float64]:
    """Compute distances (n,) of positions (n, 3) from the nearest perspective camera, m.

    Infinite without a perspective camera.
    """
