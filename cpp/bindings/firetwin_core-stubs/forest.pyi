"""Trees and grass from fuel: one per cell (Algorithm 2), or stands of hundreds a hectare."""

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

class Stems:
    """n trees of stands, in order of their cells."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def size_class(self) -> NDArray[np.uint8]:
        """SMALL 0 below 8 m, MEDIUM 1, LARGE 2 from 22 m."""
    @property
    def model(self) -> NDArray[np.uint8]:
        """Index in the class: 0..1 for LARGE, 0..3 for the others."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """Height in metres (the models are one metre tall), 3.1 to 41."""
    @property
    def width(self) -> NDArray[np.float32]:
        """Crown widening: width over the model's, which makes up for thinned trees; 1 without thinning."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """Radians about the vertical."""
    @property
    def key(self) -> NDArray[np.int64]:
        """(n,) identifier of a tree, whatever the thinning: it keys the tree's random numbers."""
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

def stems(canopy_fuel: ArrayLike) -> NDArray[np.float64]:
    """Stems per m2 of a stand with this canopy fuel load W (kg/m2), of the same shape; at most 0.09.

    453 W^0.53 per hectare: ln W = -4.824 + 0.804 ln B + 0.333 ln N (mixed conifer: Cruz, Alexander and
    Wakimoto 2003, Int. J. Wildland Fire 12:39-50) for N stems per hectare with a basal area B (m2/ha) of
    N pi/4 D^2 and a quadratic mean diameter D of 0.30 m W^(1/4) (assumed). None at 0.01 kg/m2 and less, or
    where the fuel is not finite.
    """

def stand(
    canopy_fuel: ArrayLike,
    latitude: ArrayLike,
    longitude: ArrayLike,
    elevation: ArrayLike,
    frame: LocalFrame,
    seed: int = 0,
    retained: ArrayLike | None = None,
    mask: ArrayLike | None = None,
) -> Stems:
    """Trees of stands by Matérn hard-core thinning, from canopy_fuel (fy, fx) kg/m2 on latitude, longitude.

    Fuel, elevation (fy, fx) m and `retained` are bilinear between the cells' middles. Cells with 0.01 kg/m2 or
    less, or without elevation, are clear.

    The places are a Matérn type II hard-core process (1960). No two of d trees per m2 are nearer than
    sqrt(1 / (pi d)), 0.56 of their mean spacing (1 to 3 % less, as points of late marks are left out). Beyond
    twice that distance the pair correlation is 1. There is no lattice and no period. Diameters fall off exponentially from 5 cm up (de
    Liocourt 1898); heights follow from them by the Western Sierra variant of the Forest Vegetation Simulator:
    feet = 4.5 + exp(4.86039 - 9.32795 / (inches + 1)), the same for its pines, firs and cedar.

    Parameters
    ----------
    retained
        (fy, fx) share of the stems to retain, 0 to 1: the oldest, and so mostly the largest. Trees of a share
        are a subset of the trees of any larger share. Crowns are widened, so that their summed area stays the
        same; cover, with overlaps, stays within 4 % of the ground (measured for 3 to 100 % and 0.2 to 2.5 kg/m2).
    mask
        (fy, fx) bool; only cells that are true are looked at, and their trees are the same as without it.
    """
