from collections.abc import Mapping
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

class Puffs:
    """Smoke of one moment as n balls; the state at any time needs no frame before it."""

    @property
    def position(self) -> NDArray[np.float32]:
        """(n, 3) metres."""
    @property
    def radius(self) -> NDArray[np.float32]:
        """(n,) metres."""
    @property
    def density(self) -> NDArray[np.float32]:
        """(n,) dilution 0..1 (1 = fresh smoke)."""
    @property
    def age(self) -> NDArray[np.float32]:
        """(n,) seconds."""
    @property
    def mass(self) -> NDArray[np.float64]:
        """(n,) kg of smoke."""

def puffs(
    time: float,
    arrival: ArrayLike,
    fuel: ArrayLike,
    position: ArrayLike,
    wind: ArrayLike,
    cell_area: float,
    interval: float = 60.0,
    max_age: float = 3600.0,
    burn_time: float = 600.0,
    stability: float = 1.0e-4,
    seed: int = 0,
    smoke_fraction: float = 0.02,
    heat_of_combustion: float = 17.433e6,
) -> Puffs:
    """Closed-form puffs at `time` (s) from cells that burned: arrival (n,) s, fuel (n,) kg/m2 consumed,
    position (n, 3) m, wind (2,) or (n, 2) m/s. Rise after Briggs; see the C++ header for the formulas."""

class Frame:
    """What one VDB file holds."""

    @property
    def active_voxels(self) -> int: ...
    @property
    def bytes(self) -> int: ...
    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) metres, world space."""
    @property
    def mass(self) -> float:
        """kg of smoke in the file, integrated over the `mass` weights before quantisation."""

def write_smoke(
    path: str | PathLike[str],
    puffs: Puffs,
    voxel_size: float,
    flame_position: ArrayLike | None = None,
    flame_power: ArrayLike | None = None,
    metadata: Mapping[str, str] | None = None,
) -> Frame:
    """Write grids `density` (0..1 clipped signed distance to the puffs: (distance + 300) / 600),
    `dilution` (0..1), `temperature` (K) and, with flames (n, 3) m and (n,) W, `glow` (0..1) and `flame`
    (0..1), half precision with Blosc, to a temporary file that is then renamed."""

def write(
    path: str | PathLike[str],
    grids: Mapping[str, ArrayLike],
    voxel_size: float,
    origin: ArrayLike = (0.0, 0.0, 0.0),
    half: bool = True,
    tolerance: float = 0.0,
    metadata: Mapping[str, str] | None = None,
) -> Frame:
    """Write dense arrays (nx, ny, nz) as sparse fog volumes of cubic voxels (m); origin is voxel (0,0,0)'s centre."""
