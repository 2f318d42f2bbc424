"""Heat flux at any time, and fire emitters."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .run import Run

class Emitters:
    """The n fire emitters at one time, one per burning cell (Algorithm 1 of the FIRETWIN paper)."""

    @property
    def cell(self) -> NDArray[np.int64]:
        """(n,) flat index y*nx + x."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) east, north, up in metres."""
    @property
    def intensity(self) -> NDArray[np.float64]:
        """(n,) normalised intensity F_curved, 0..1."""
    @property
    def scale(self) -> NDArray[np.float64]:
        """(n,) size, 100..150."""
    @property
    def colour(self) -> NDArray[np.float64]:
        """(n,) colour value, 100..500."""
    @property
    def flux(self) -> NDArray[np.float32]:
        """(n,) W/m2."""
    @property
    def invalid(self) -> int:
        """Number of cells without an emitter because their flux is NaN."""
    def __len__(self) -> int: ...

def emitters(flux: ArrayLike, position: ArrayLike, flux_min: float, flux_max: float) -> Emitters:
    """Create emitters by Algorithm 1 of the FIRETWIN paper for all cells with flux > 0.

    F_curved = clamp((F - flux_min) / (flux_max - flux_min), 0, 1)^1.5, scale = 100 + 50 F_curved and
    colour = 100 + 400 F_curved.

    Parameters
    ----------
    flux
        (ny, nx) W/m2.
    position
        (ny, nx, 3) m.
    flux_min, flux_max
        Range of the flux over the complete run, W/m2.

    Raises
    ------
    ValueError
        A shape does not fit, or the range is not finite and ascending.
    """

class Interpolator:
    """Temporal interpolation of a run's heat flux, with a cache of frames.

    The result is exact at model times. In between, F^1.5, which determines the size of flames, is linear in
    cells that burned before, and so is its sum over all cells. A cell that ignites in the interval stays cold
    until its ignition time (cpp/flux/interval_interpolator.hpp, cpp/flux/arrival.hpp). Cells with less than 1
    W/m2 that the front has not reached are 0. All cells are 0 before the first and after the last model time.

    The cost is proportional to the number of burning cells. In sequential access each frame is read once. The
    class is thread-safe, and results do not depend on the order of calls.
    """

    def __init__(self, run: Run) -> None:
        """Compute ignition times. A run without fuel_arrival_time is read completely, once."""
    def at(self, time: float) -> NDArray[np.float32]:
        """Interpolate the heat flux (ny, nx), W/m2, to `time` (s since start). Raises ValueError for NaN."""
    def burning(self, time: float) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Return the cells with nonzero flux: (n,) ascending flat indices y*nx + x, and (n,) fluxes, W/m2."""

def at_time(run: Run, time: float) -> NDArray[np.float32]:
    """Interpolate the heat flux to one time. For several times reuse an `Interpolator`."""
