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

def at_time(run: Run, time: float) -> NDArray[np.float32]:
    """Heat flux (ny, nx) in W/m2 at any time (seconds since start); zero outside the run.

    Exact at the model times. Between them F^1.5, on which the size of flames depends, is even in every cell
    that burned before and in the sum of all; cells that first burn in between stay cold until the moving
    front reaches them. The C++ header says how. The first call scans the run for its arrival times.
    """

def arrival_time(run: Run, averaged: bool = True) -> NDArray[np.float32]:
    """When each cell begins to burn (ny, nx), s since start and between the model times; NaN where never.

    From how the flux of a cell grows and how the front runs through its neighbours; within the interval before
    the first model time with flux. `averaged` says whether the run's fluxes are means over the `mean_s` of
    run.toml, or else the interval, that ends at their time, or values at that time. The C++ header has the formulas.
    """
