"""3D Tiles: the choice of tiles for a shot."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .lod import ViewSet

REPLACES: int
UNCONDITIONAL: int
CONTENT: int
PENDING: int
BROKEN: int
SHUT: int
PASSES: int

def screen_error(
    centre: ArrayLike,
    axis: ArrayLike,
    half: ArrayLike,
    round: ArrayLike,
    error: ArrayLike,
    views: ViewSet,
    pixels: ArrayLike,
    max_distance: float = float("inf"),
    margin: float = 0.0,
    shadows: bool = False,
) -> NDArray[np.float64]:
    """(n,) screen-space error of tiles in pixels: the largest over the views that see them; -1: none does.

    Perspective: error * pixels / max(distance, 1e-7 m), with the distance of the camera from the nearest point
    of the tile's volume. Orthographic: error * pixels. A view sees a tile by its bounding sphere (see
    `lod.visible_mask`, also for the last three arguments).

    Parameters
    ----------
    centre, axis, half, round
        Volumes: boxes with centres (n, 3) m, orthonormal directions of edges (n, 3, 3) as rows, half lengths
        (n, 3) m, widened by (n,) m. A sphere is a box without extent.
    error
        (n,) geometric errors, m.
    pixels
        (m,) of each view. Perspective: pixels of 1 m at a distance of 1 m, height / (2 tan(angle / 2)).
        Orthographic: pixels of 1 m.

    Raises
    ------
    ValueError
        A shape does not fit, or a number is below 0 or NaN.
    """

def holds_any(
    centre: ArrayLike, axis: ArrayLike, half: ArrayLike, round: ArrayLike, position: ArrayLike
) -> NDArray[np.bool_]:
    """(n,) whether any position (m, 3) is inside each volume (see `screen_error`)."""

class Cut:
    """The tiles that a shot shows (see `select`)."""

    @property
    def tiles(self) -> NDArray[np.int64]:
        """Numbers of the tiles whose content is shown, ascending."""
    @property
    def expand(self) -> NDArray[np.int64]:
        """Numbers of pending tiles whose children the cut needs, ascending."""
    @property
    def stands(self) -> NDArray[np.int64]:
        """Numbers of tiles that stand in for broken ones below them."""
    @property
    def missed(self) -> NDArray[np.int64]:
        """Numbers of broken tiles for which no tile stands in, or an ancestor that is shown anyway."""
    @property
    def error(self) -> float:
        """Screen-space error above which tiles are refined, pixels: what was asked for, or more to fit."""
    @property
    def fits(self) -> bool:
        """Whether the cut keeps within the budget."""
    @property
    def bytes(self) -> int:
        """Sum over the tiles shown."""
    @property
    def triangles(self) -> int:
        """Sum over the tiles shown."""

def select(
    parent: ArrayLike,
    flags: ArrayLike,
    screen_error: ArrayLike,
    bytes: ArrayLike,
    triangles: ArrayLike,
    error: float,
    max_tiles: int = -1,
    max_bytes: int = -1,
    max_triangles: int = -1,
) -> Cut:
    """Choose one cut of a tree of n tiles. The time is linear in n.

    A tile is refined where its screen-space error is above `error`, and UNCONDITIONAL ones always. Children of
    a tile that REPLACES are chosen all or none; those that no view sees stay coarse. Other children are chosen
    each by itself, where a view sees it. In place of a BROKEN tile its nearest ancestor with content is shown.
    Beyond the budget the error is raised for all tiles to the next screen-space error of any tile at which the
    cut fits, found by bisection; where nothing fits the coarsest cut is given.

    Parameters
    ----------
    parent
        (n,) number of the parent, smaller than the tile's own; -1 for roots.
    flags
        (n,) sums of: REPLACES; UNCONDITIONAL; CONTENT: it has something to show; PENDING: it has children that
        are not read yet; BROKEN: its content cannot be had; SHUT: no eye is in its request volume, so that it
        and what is below is left out; PASSES: it stands for its children and shows its own content with them.
    screen_error
        (n,) pixels; below 0: no view sees the tile.
    bytes, triangles
        (n,) of the contents, 0 where unknown.
    max_tiles, max_bytes, max_triangles
        Budget; below 0: no limit.

    Raises
    ------
    ValueError
        A shape does not fit, a parent does not come before its child, or an error is negative or NaN.
    """
