"""Heat flux at any time, and the fire emitters that show it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .run import Run

class Emitters:
    """Fire emitters of one moment, one per burning cell (Algorithm 1), n of them."""

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
        """How many cells held NaN and so made no emitter."""
    def __len__(self) -> int: ...

def emitters(flux: ArrayLike, position: ArrayLike, flux_min: float, flux_max: float) -> Emitters:
    """Algorithm 1: flux (ny, nx) W/m2 and position (ny, nx, 3) metres -> emitters where flux > 0."""

class Interpolator:
    """The heat flux of a run's fire at any time; keeps what it has read.

    Exact at the model times. Between them F^1.5, on which the size of flames depends, is even in every cell
    that burned before and in the sum of all; cells that first burn in between stay cold until the moving
    front reaches them (cpp/flux/step.hpp says how, cpp/flux/arrival.hpp when). Cells that the fire has not
    reached and that have less than 1 W/m2, such as models leave where nothing burns, are 0. Before the first
    and after the last model time all are.

    A moment costs what burns in it, and frames asked for in order are read once each. Any thread may ask, in
    any order, for the same results.
    """

    def __init__(self, run: Run) -> None:
        """Find when cells begin to burn; that reads all of a run without fuel_arrival_time once."""
    def at(self, time: float) -> NDArray[np.float32]:
        """Heat flux (ny, nx) in W/m2 at `time` (seconds since start). ValueError when that is NaN."""
    def burning(self, time: float) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """The cells whose flux is not 0, and their flux: (n,) ascending flat indices y*nx + x, (n,) W/m2."""

def at_time(run: Run, time: float) -> NDArray[np.float32]:
    """Interpolator(run).at(time); who asks for more than one moment keeps an Interpolator."""
