"""Trees and grass from fuel loads: one per cell (Algorithm 2), or stands of hundreds per hectare."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import LocalFrame

SMALL: int
MEDIUM: int
LARGE: int

class Trees:
    """n trees, ordered by cell."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def size_class(self) -> NDArray[np.uint8]:
        """(n,) SMALL 0, MEDIUM 1, LARGE 2."""
    @property
    def model(self) -> NDArray[np.uint8]:
        """(n,) model index in the class: 0..1 for LARGE, 0..3 for the others."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """(n,) height in metres (the models are one metre tall)."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """(n,) rotation about the vertical, radians."""
    def __len__(self) -> int: ...

class Stems:
    """n trees of stands, ordered by cell."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def size_class(self) -> NDArray[np.uint8]:
        """(n,) SMALL 0 below 8 m, MEDIUM 1, LARGE 2 from 22 m."""
    @property
    def model(self) -> NDArray[np.uint8]:
        """(n,) model index in the class: 0..1 for LARGE, 0..3 for the others."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """(n,) height in metres (the models are one metre tall), 3.1 to 41."""
    @property
    def width(self) -> NDArray[np.float32]:
        """(n,) crown width relative to the model, which compensates for thinned trees; 1 without thinning."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """(n,) rotation about the vertical, radians."""
    @property
    def key(self) -> NDArray[np.int64]:
        """(n,) identifier of a tree, independent of thinning; key of its random numbers."""
    def __len__(self) -> int: ...

class Grass:
    """n clumps of grass, ordered by cell."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*fx + x of the fuel cell, ascending."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def rotation(self) -> NDArray[np.float32]:
        """(n,) rotation about the vertical, radians."""
    @property
    def scale(self) -> NDArray[np.float32]:
        """(n,) always 1."""
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
    """Place one tree per cell with canopy fuel (Algorithm 2 of the FIRETWIN paper).

    Parameters
    ----------
    canopy_fuel
        (fy, fx) kg/m2. Cells with fuel or elevation that is not finite have no tree.
    latitude, longitude
        (fy,) and (fx,) degrees.
    elevation
        (fy, fx) m, interpolated bilinearly at the tree's position.
    frame
        Local frame of the positions.
    seed
        Seed of the random numbers.
    max_fuel
        Fuel of the tallest trees, kg/m2. Default: the largest finite fuel.
    jitter
        1: anywhere in the cell, 0: at its centre.
    mask
        (fy, fx) bool: cells with a tree. It does not affect the trees of other cells.
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
    """Place one clump of grass per cell with surface fuel (fy, fx) kg/m2 (Algorithm 2).

    Its position is 0.70 m below the position of the cell's tree for the same seed and jitter. The other
    parameters are as in `trees`.
    """

def stems(canopy_fuel: ArrayLike) -> NDArray[np.float64]:
    """Compute the stem density (1/m2) of stands from their canopy fuel load W (kg/m2), at most 0.09.

    453 W^0.53 per hectare: ln W = -4.824 + 0.804 ln B + 0.333 ln N (mixed conifer: Cruz, Alexander and
    Wakimoto 2003, Int. J. Wildland Fire 12:39-50) for N stems per hectare with a basal area B (m2/ha) of
    N pi/4 D^2 and a quadratic mean diameter D of 0.30 m W^(1/4) (assumed). The density is 0 up to 0.01 kg/m2
    and if the fuel is not finite. The result has the shape of the argument.
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
    """Generate the trees of stands by Matérn hard-core thinning.

    Positions are a Matérn type II hard-core process (1960). With d trees per m2, no two are closer than
    sqrt(1 / (pi d)), 0.56 of their mean spacing (1 to 3 % less, because points with large marks are skipped).
    Beyond twice that distance the pair correlation is 1; the pattern has neither a lattice nor a period.
    Diameters are exponentially distributed from 5 cm up (de Liocourt 1898); heights follow from the Western
    Sierra variant of the Forest Vegetation Simulator: feet = 4.5 + exp(4.86039 - 9.32795 / (inches + 1)),
    equal for its pines, firs and cedar.

    Parameters
    ----------
    canopy_fuel
        (fy, fx) kg/m2. Cells with 0.01 kg/m2 or less, or without elevation, have no trees.
    latitude, longitude
        (fy,) and (fx,) degrees.
    elevation
        (fy, fx) m. Fuel, elevation and `retained` are interpolated bilinearly between cell centres.
    frame
        Local frame of the positions.
    seed
        Seed of the random numbers.
    retained
        (fy, fx) share of the stems to retain, 0 to 1: the oldest, hence mostly the largest. The trees of a
        share are a subset of the trees of any larger share. Crowns are widened to conserve the summed crown
        area; the covered area, with overlaps, changes by less than 4 % of the ground (measured for shares of
        3 to 100 % and 0.2 to 2.5 kg/m2).
    mask
        (fy, fx) bool: cells with trees. It does not affect the trees of other cells.
    """
