"""Trees and grass from fuel (Algorithm 2)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import LocalFrame

SMALL: int
MEDIUM: int
LARGE: int

class Trees:
    """n trees, in order of their cells."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def size_class(self) -> NDArray[np.uint8]:
        """SMALL 0, MEDIUM 1, LARGE 2."""
    @property
    def model(self) -> NDArray[np.uint8]:
        """Index in the class: 0..1 for LARGE, 0..3 for the others."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """Height in metres (the models are one metre tall)."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """Radians about the vertical."""
    def __len__(self) -> int: ...

class Grass:
    """n clumps of grass, in order of their cells."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """Radians about the vertical."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """Always 1."""
    def __len__(self) -> int: ...

def trees(
    canopy_fuel: ArrayLike,
    latitude: ArrayLike,
    longitude: ArrayLike,
    elevation: ArrayLike,
    frame: LocalFrame,
    seed: int = 0,
    max_fuel: float | None = None,
    jitter: float = 1.0,
    mask: ArrayLike | None = None,
) -> Trees:
    """Algorithm 2: canopy_fuel (fy, fx) kg/m2 on latitude (fy,), longitude (fx,) -> trees.

    `elevation` (fy, fx) m gives a tree its height, bilinear at its jittered place. `max_fuel` defaults to
    the largest finite fuel. `jitter` 1 spreads over the whole cell, 0 keeps the centre. Cells whose fuel or
    elevation is not finite have no tree. Of `mask` (fy, fx), bool, only cells that are true are looked at,
    and their trees are the same as without it.
    """

def grass(
    surface_fuel: ArrayLike,
    latitude: ArrayLike,
    longitude: ArrayLike,
    elevation: ArrayLike,
    frame: LocalFrame,
    seed: int = 0,
    jitter: float = 1.0,
    mask: ArrayLike | None = None,
) -> Grass:
    """Algorithm 2's grass: one clump, 0.70 m lower, in each cell with surface fuel (fy, fx) kg/m2.

    It stands where the tree of its cell stands or would stand (for the same seed and jitter).
    `mask` as for trees.
    """
