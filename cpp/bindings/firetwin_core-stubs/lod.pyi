"""What a shot can see: distance levels, budgets, views and stable slots."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def levels(distance: ArrayLike) -> NDArray[np.uint8]:
    """Level of each distance (m): <= 1500 -> 0, <= 3500 -> 1, else (and for NaN) 2."""

class Table:
    """Levels of detail by distance: up to each of the thresholds (m) one level, and beyond them one more."""

    def __init__(
        self, thresholds: Sequence[float] = (1500.0, 3500.0), multipliers: Sequence[float] = (1.0, 0.7, 0.4)
    ) -> None: ...
    @property
    def thresholds(self) -> list[float]:
        """m, ascending."""
    @property
    def multipliers(self) -> list[float]:
        """Of particles, for each level: one more than thresholds."""
    def levels(self, distance: ArrayLike) -> NDArray[np.uint8]:
        """Level of each distance (m), of the same shape; NaN has the last."""
    def multiplier(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Particle multiplier of each distance (m), of the same shape."""

def select(position: ArrayLike, camera: ArrayLike, budget: int) -> NDArray[np.int64]:
    """Indices of the `budget` positions (n, 3) nearest to any camera (m, 3), nearest first, ties by index."""

class Occluder:
    """The ground as what hides things: of a continuous surface, the heights that it is nowhere below."""

    def __init__(self, position: ArrayLike) -> None:
        """The surface through position (rows, columns, 3) m: neighbours are joined by triangles.

        Finer surfaces are hidden behind as well if they are nowhere below these triangles. What it does not
        cover hides nothing.

        Raises
        ------
        ValueError
            There are fewer than 2 x 2 places, they cover no area, or one is not finite.
        """

class Sight:
    """What some views see, usually all that a shot films."""

    def __init__(
        self,
        camera: ArrayLike,
        rotation: ArrayLike,
        half: ArrayLike,
        sun: ArrayLike = (0.0, 0.0, 0.0),
        parallel: ArrayLike = False,
        clear: ArrayLike = True,
        ground: Occluder | None = None,
        floor: float = 0.0,
    ) -> None:
        """Make m views; all but the cameras may be the same for all of them. Neighbours on a path come together.

        Parameters
        ----------
        camera
            (m, 3) m.
        rotation
            (m, 3, 3) to world axes; the camera looks along its -z, y is up.
        half
            (m, 2) tangents of half the angles of view, across and from bottom to top; with parallel lines of
            sight half the width and height of the picture, m.
        sun
            (m, 3) unit vectors towards what throws shadows; under one degree, and for 0, there are none.
        parallel
            (m,) whether lines of sight are parallel.
        clear
            (m,) whether the camera is above the ground: only then does the ground hide anything from it.
        ground
            What hides; without it nothing does.
        floor
            m, where shadows end at the latest: no ground is lower.

        Raises
        ------
        ValueError
            A shape does not fit, a number is not finite, `half` is not above 0, or a rotation is none.
        """

def seen(
    position: ArrayLike,
    radius: ArrayLike,
    sight: Sight,
    reach: float = float("inf"),
    margin: float = 0.0,
    shadows: bool = False,
) -> NDArray[np.bool_]:
    """(n,) which balls at position (n, 3) of radius (n,) m any view sees.

    Nothing that is visible is left out; some that hide just behind an edge are kept. A ball with NaN is never
    seen. All views count exactly, however many: they are asked as a tree, whose branches bound how far the
    cameras move and turn between its views, after squares of ground with all that stands in them.

    Parameters
    ----------
    reach
        m; what is farther from a camera in perspective does not count.
    margin
        m that every view is wider and higher.
    shadows
        Whether what throws its shadow on a place (air or ground) that is seen counts as well.

    Raises
    ------
    ValueError
        A shape does not fit, or radius, reach or margin is below 0.
    """

def distance(position: ArrayLike, sight: Sight) -> NDArray[np.float64]:
    """(n,) least distance of position (n, 3) from the cameras in perspective, m; infinite without any."""
