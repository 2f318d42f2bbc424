"""Heat flux at any time, and the fire emitters that show it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .run import Run

class Emitters:
    """Fire emitters at one time, one per burning cell (Algorithm 1), n of them."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*nx + x."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def intensity(self) -> NDArray[np.float64]:
        """(n,) F_curved in 0..1."""
    @property
    def scale(self) -> NDArray[np.float64]:
        """(n,) 100..150."""
    @property
    def colour(self) -> NDArray[np.float64]:
        """(n,) 100..500."""
    @property
    def flux(self) -> NDArray[np.float32]:
        """(n,) W/m2."""
    @property
    def invalid(self) -> int:
        """Number of cells without an emitter because their flux is NaN."""
    def __len__(self) -> int: ...

def emitters(flux: ArrayLike, position: ArrayLike, flux_min: float, flux_max: float) -> Emitters:
    """Algorithm 1: flux (ny, nx) W/m2 and position (ny, nx, 3) metres -> emitters where flux > 0."""

class Interpolator:
    """Heat flux of a run at any time: interpolation in time, with a cache of frames.

    The result is exact at model times. Between them F^1.5, which sets the size of flames, is linear in cells
    that burned before, and so is its sum over all cells. A cell that ignites in between stays cold until its
    ignition time (cpp/flux/interval_interpolator.hpp, cpp/flux/arrival.hpp). Cells that the front has not
    reached and that have less than 1 W/m2 are 0. All cells are 0 before the first and after the last model time.

    The cost of a time is that of its burning cells. Frames in order are read once each. The class is
    thread-safe, and the result does not depend on the order of calls.
    """

    def __init__(self, run: Run) -> None:
        """Find ignition times. This reads all of a run without fuel_arrival_time once."""
    def at(self, time: float) -> NDArray[np.float32]:
        """Heat flux (ny, nx) in W/m2 at `time` (seconds since start). ValueError when that is NaN."""
    def burning(self, time: float) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """The cells whose flux is not 0, and their flux: (n,) ascending flat indices y*nx + x, (n,) W/m2."""

def at_time(run: Run, time: float) -> NDArray[np.float32]:
    """Interpolator(run).at(time). For several times make one Interpolator."""
