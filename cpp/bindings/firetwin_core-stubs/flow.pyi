"""Anelastic flow solver for a fire's smoke plume, and procedural smoke detail below its cells."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .volume import SparseSmoke

class SolverSettings:
    """Settings of a `Solver`: sponge layer, Rayleigh damping, drag, subgrid mixing, sources and gusts.

    Parameters
    ----------
    sponge_width
        Width of the lateral sponge layer, cells; less than half of the domain. Its weight falls off
        quadratically.
    sponge_time
        Relaxation time of the sponge layer at the lateral boundaries, s.
    damping_share
        Share of the domain's height, below the top, that has Rayleigh damping, 0 to 1.
    damping_time
        Relaxation time of the Rayleigh damping at the top, s.
    drag_time
        Relaxation time of the lowest level's wind to the ambient wind, s.
    smagorinsky
        Smagorinsky constant of the subgrid mixing; 0 leaves only the advection's numerical diffusion.
    source_depth
        e-folding height of heat and smoke sources, m.
    gust_strength
        Standard deviation of the logarithm of a lognormal factor on the sources; 0: no gusts. The factor
        redistributes heat and smoke and conserves their sums.
    gust_size, gust_time
        Correlation length (m) and time (s) of this factor.
    seed
        Seed of the gusts.

    Notes
    -----
    The sponge layer and the Rayleigh damping relax wind, temperature and water towards the ambient air. Smoke
    is not relaxed: it leaves with the wind.
    """

    def __init__(
        self,
        *,
        sponge_width: float = 8.0,
        sponge_time: float = 40.0,
        damping_share: float = 0.22,
        damping_time: float = 60.0,
        drag_time: float = 300.0,
        smagorinsky: float = 0.18,
        source_depth: float = 90.0,
        gust_strength: float = 0.0,
        gust_size: float = 400.0,
        gust_time: float = 90.0,
        seed: int = 0,
    ) -> None: ...
    @property
    def sponge_width(self) -> float:
        """Width of the lateral sponge layer, cells."""
    @property
    def sponge_time(self) -> float:
        """Relaxation time of the sponge layer, s."""
    @property
    def damping_share(self) -> float:
        """Share of the domain's height that has Rayleigh damping, 0 to 1."""
    @property
    def damping_time(self) -> float:
        """Relaxation time of the Rayleigh damping at the top, s."""
    @property
    def drag_time(self) -> float:
        """Relaxation time of the lowest level's wind, s."""
    @property
    def smagorinsky(self) -> float:
        """Smagorinsky constant of the subgrid mixing."""
    @property
    def source_depth(self) -> float:
        """e-folding height of heat and smoke sources, m."""
    @property
    def gust_strength(self) -> float:
        """Standard deviation of the logarithm of the factor on the sources."""
    @property
    def gust_size(self) -> float:
        """Correlation length of gusts, m."""
    @property
    def gust_time(self) -> float:
        """Correlation time of gusts, s."""
    @property
    def seed(self) -> int:
        """Seed of the gusts."""

class Domain:
    """Computational domain of a `Solver`: a terrain-following grid of square columns.

    Parameters
    ----------
    levels
        (nz + 1,) heights of level faces above ground, m, increasing from 0.
    shape
        Rows and columns. Row 0 is the southernmost, column 0 the westernmost.
    spacing
        Side of a square cell, m.
    corner
        x and y of the south-west corner, m.
    ground
        (rows, columns) elevation of cell centres, m; None is flat terrain at 0. Levels follow the terrain
        less with height, up to a flat top. Slopes must be well below 1. Relief must be at most half of the
        domain's height.
    """

    def __init__(
        self,
        levels: ArrayLike,
        shape: tuple[int, int],
        spacing: float,
        corner: tuple[float, float] = (0.0, 0.0),
        ground: ArrayLike | None = None,
    ) -> None: ...

class Profile:
    """Vertical profile of the ambient air (sounding). Values are linear between heights, constant outside.

    Parameters
    ----------
    height
        (n,) m above the domain's mean ground, increasing.
    potential_temperature
        (n,) K.
    wind
        (n, 2) east and north, m/s; its heights are above the local ground.
    water
        (n,) mixing ratio of vapour and cloud, kg/kg; None is dry air without condensation.
    pressure
        At height 0, Pa.
    """

    def __init__(
        self,
        height: ArrayLike,
        potential_temperature: ArrayLike,
        wind: ArrayLike,
        water: ArrayLike | None = None,
        pressure: float = 101325.0,
    ) -> None: ...

class Solver:
    """Anelastic flow solver for a buoyant smoke plume on a terrain-following Arakawa C grid.

    The equations are from Lipps and Hemler (1982, "A scale analysis of deep moist convection", J. Atmos. Sci.
    39). Arrays are (level, row, column).

    Parameters
    ----------
    domain
        The grid and its terrain.
    profile
        The ambient air.
    settings
        None is `SolverSettings()`.

    Notes
    -----
    Warm air accelerates up slopes. Air at rest stays at rest over any terrain. The pressure solver assumes
    flat levels.

    Fields are float32; sums are float64. The result is the same for any number of threads. Memory is about
    100 bytes a cell, 160 in a nest. It includes two ghost cells on each side, and rows are padded to
    multiples of 16 cells.

    Raises
    ------
    ValueError
        A number is out of range, or shapes do not match.
    """

    def __init__(self, domain: Domain, profile: Profile, settings: SolverSettings | None = None) -> None: ...
    def nest(self, domain: Domain, settings: SolverSettings | None = None) -> Solver:
        """Make a one-way nest: a finer domain in this one, two or more of this domain's cells from its sides.

        The nest starts from the present state of this flow. Its boundary values and ambient wind follow this
        flow, linearly between its steps; the nest does not feed back. Step this flow first and then the nest,
        up to the same time. Set the sources of both. `settings` None is `SolverSettings(sponge_width=10.0,
        sponge_time=8.0)`.
        """

    def set_sources(
        self, position: ArrayLike, heat: ArrayLike, smoke: ArrayLike, water: ArrayLike | None = None
    ) -> None:
        """Set the fire's sources: position (n, 2) m, heat (n,) W into the air, smoke and vapour (n,) kg/s.

        A source is distributed bilinearly to the four nearest columns. Sources outside of the outermost cell
        centres are ignored.
        """

    def set_wind(self, wind: ArrayLike) -> None:
        """Change the ambient wind (n, 2), m/s, one for each height; the change is added to the flow."""

    def step(self, dt: float, count: int = 1) -> None:
        """Advance by `count` time steps of `dt` s. Advection has substeps below Courant number 0.8.

        A good step is 0.05 s per metre of `spacing`. Raises `Error` if the flow diverges to infinity.
        """

    @property
    def time(self) -> float:
        """Model time since the start, s."""
    @property
    def steps(self) -> int:
        """Number of time steps since the start."""
    @property
    def substeps(self) -> int:
        """Number of advection substeps in the last step."""
    @property
    def courant(self) -> float:
        """Largest Courant number of the last step."""
    @property
    def divergence(self) -> float:
        """Largest residual |div(density x wind)| / density after the pressure projection, 1/s."""
    @property
    def levels(self) -> NDArray[np.float64]:
        """(nz + 1,) heights of level faces above ground, m."""
    @property
    def density(self) -> NDArray[np.float64]:
        """(nz,) air density of each level, kg/m3."""
    @property
    def spacing(self) -> float:
        """Side of a square cell, m."""
    @property
    def corner(self) -> tuple[float, float]:
        """South-west corner (x, y), m."""
    @property
    def shape(self) -> tuple[int, int, int]:
        """Levels, rows, columns."""
    def smoke(self) -> NDArray[np.float32]:
        """Return smoke density (nz, ny, nx), kg/m3, which the true cell volumes turn into airborne mass."""
    def age(self) -> NDArray[np.float32]:
        """Return the mean age of the smoke since emission (nz, ny, nx), s; 0 without smoke."""
    def velocity(self) -> NDArray[np.float32]:
        """Return the wind (nz, ny, nx, 3) at cell centres, m/s east, north and (also along slopes) up."""
    def temperature_excess(self) -> NDArray[np.float32]:
        """Return the temperature excess over the ambient air at the same height (nz, ny, nx), K."""
    def cloud(self) -> NDArray[np.float32]:
        """Return the cloud water mixing ratio (nz, ny, nx), kg/kg."""
    def heights(self) -> NDArray[np.float32]:
        """Return the elevation of cell centres (nz, ny, nx), m, in the ground's datum."""
    def mass(self) -> dict[str, float]:
        """Return the smoke mass budget, kg: initial + emitted + entered + rounding = airborne + left."""
    def heat(self) -> dict[str, float]:
        """Return the heat budget, J.

        `given` is released by sources. `warmed` is `given` divided by the Exner function at the place of
        release. `held` is cp x mass x potential temperature excess. In neutral air held = warmed until the
        plume reaches a boundary.
        """
    def state(self) -> dict[str, NDArray]:
        """Copy a checkpoint for `restore`: u, v, w, theta, smoke, age, water (float32), account, wind."""
    def restore(self, state: dict[str, NDArray]) -> None:
        """Restart from a checkpoint of a solver with the same arguments; the run continues bit for bit.

        Set the sources again afterwards. Restore the outer flow before its nest, both from the same time.
        """

class Drift:
    """Advected texture coordinates (Neyret 2003, "Advected textures"): displacement of the air.

    Displacement counts from the start of a phase. Noise at (place - drift) travels with the flow. Shear
    stretches noise into streaks, so each phase restarts every `period` s. Two phases, half a period apart,
    are blended. Advection is semi-Lagrangian with linear interpolation, on every other cell. The result is
    the same for any number of threads.
    """

    def __init__(self, solver: Solver, period: float = 120.0) -> None: ...
    def advance(self) -> None:
        """Advect up to the solver's time with its present wind; call it after each solver step."""
    def values(self) -> NDArray[np.float32]:
        """Return the drift of both phases (nz', ny', nx', 2, 3), m east, north and up along the levels.

        Values are at the centres of cells 0, 2, 4 ... along each axis.
        """
    def restore(self, time: float, values: ArrayLike) -> None:
        """Restart from the values of a given time (s)."""
    @property
    def time(self) -> float:
        """Time up to which the drift is advected, s."""
    @property
    def weights(self) -> list[float]:
        """Blend weight of each phase, 0 where it starts and ends; the squares sum to 1."""
    @property
    def turns(self) -> list[int]:
        """Number of restarts of each phase."""

class Detail:
    """Procedural smoke detail below the cells of a flow, for one snapshot.

    Noise that is advected with the air modulates the logarithm of the smoke. A threshold then removes thin
    smoke. Vigorous smoke (rising, warm, fresh or dense) has billows with crisp edges (Worley noise). Other
    smoke has soft
    veils (Perlin noise). Formulas and constants are in cpp/flow/detail.hpp, detail.cpp and
    detail_brush.cpp; thresholds and gains are chosen by eye.

    Arrays are (nz, ny, nx) on square cells: all cells of a solver, or a block that reaches the ground.

    Parameters
    ----------
    spacing, corner
        Side of a cell, and x and y of the south-west corner, m.
    levels
        (nz,) heights of cell centres above ground, m.
    heights
        Elevation of cell centres in the ground's datum, m.
    ground
        (ny, nx) terrain elevation, m.
    smoke, age, rise
        kg/m3, s, and upward wind in m/s.
    temperature_excess
        K above the ambient air.
    drift, weights, turns
        (nz, ny, nx, 2, 3) m, and the blend weights and restart counts of a `Drift`.
    glow
        Light of flames in any unit; None: no flames.
    size
        Diameter of the largest billows, m.
    scale
        Size of the fire, relative to a fire on 200 m cells.
    blur
        Standard deviation of the drift's Gaussian blur along levels, rows and columns, cells.
    opacity
        Factor on the extinction.
    max_extinction
        Extinction at which thick smoke levels off, 1/m.
    ages
        Ages between which smoke turns from dark to white, s.
    condensation_height
        Height in the ground's datum above which vapour condenses in rising smoke, m. This smoke is white and
        thicker.
    seed
        Seed of the noise.
    """

    def __init__(
        self,
        *,
        spacing: float,
        corner: tuple[float, float],
        levels: ArrayLike,
        heights: ArrayLike,
        ground: ArrayLike,
        smoke: ArrayLike,
        age: ArrayLike,
        rise: ArrayLike,
        temperature_excess: ArrayLike,
        drift: ArrayLike,
        weights: tuple[float, float],
        turns: tuple[int, int],
        glow: ArrayLike | None = None,
        size: float = 340.0,
        scale: float = 1.0,
        blur: tuple[float, float, float] = (0.0, 0.0, 0.0),
        opacity: float = 1.0,
        max_extinction: float = 0.03,
        ages: tuple[float, float] = (20.0, 600.0),
        condensation_height: float = 1e6,
        seed: int = 0,
    ) -> None: ...
    def paint(
        self,
        origin: tuple[float, float, float],
        voxel: float,
        surface: ArrayLike,
        share: ArrayLike,
        layers: int,
        wanted: ArrayLike | None = None,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32] | None]:
        """Paint dense voxels (nx, ny, layers): extinction (1/m), freshness (1 young, 0 old or none) and glow.

        Parameters
        ----------
        origin, voxel
            Centre of the first voxel, and side of a voxel, m.
        surface
            (nx, ny) elevation of the true terrain, m.
        share
            (nx, ny) factor on the extinction, 0 to 1.
        layers
            Number of voxels along z.
        wanted
            Mask of blocks of 16^3 voxels to compute; the last blocks may be smaller. None: all blocks.
        """
    def paint_sparse(
        self,
        origin: tuple[float, float, float],
        voxel: float,
        surface: ArrayLike,
        share: ArrayLike,
        layers: int,
        wanted: ArrayLike | None = None,
        min_extinction: float = 0.0,
        log_gain: ArrayLike | None = None,
        lean: tuple[float, float] = (0.0, 0.0),
        gain_height: float = 250.0,
    ) -> SparseSmoke:
        """Paint a sparse grid. Smoke with an extinction below `min_extinction` (1/m) is set to clear.

        Parameters
        ----------
        log_gain
            Logarithm of a factor (nx, ny) on smoke near the ground; None: 0.
        lean
            Shift of this factor to the east and north over the height above ground.
        gain_height
            Height (m) at which the logarithm has decreased to 1/e.
        """
