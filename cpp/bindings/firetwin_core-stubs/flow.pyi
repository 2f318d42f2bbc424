"""Smoke of a fire as a solved buoyant flow."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .volume import SparseSmoke

class Solver:
    """Smoke of a fire as a buoyant flow of the air, on a box that follows the ground.

    Solves the anelastic equations on a staggered grid of `shape` (rows, columns) square cells of `spacing` m and
    the levels between the heights `levels` (nz + 1,) m above ground, the first 0. Arrays are (level, row, column);
    row 0 is the southernmost, column 0 the westernmost, and `corner` (x, y) m is that cell's outer corner.

    The air around, by its `height` (n,) m above the box's mean ground, rising: `potential_temperature` (n,) K;
    `wind` (n, 2) east and north, m/s, over height above the ground itself; `water` (n,) kg/kg of vapour and cloud,
    without which the air is dry and nothing condenses; `pressure` at height 0, Pa. Linear between, constant
    outside.

    `ground` (rows, columns) m: levels follow it, less and less up to an even top. Warm air is driven up slopes, and
    air at rest stays at rest; the pressure treats the levels as even, so slopes must be well below 1 and relief well
    below the box's height, at most half of it.

    Near the sides (`side_width` cells, within `side_time` s) and in the uppermost share `top` of the height (within
    `top_time` s) the flow returns to the air around, at the ground its wind does in `ground_time` s; smoke is not
    held there but leaves with the wind. Eddies smaller than the cells mix with Smagorinsky's constant `mixing`.
    Heat and smoke of a source go in as exp(-height / source_depth). Gusts share heat and smoke out unevenly among
    sources and leave their sums: a lognormal factor, `gust_strength` the standard deviation of its logarithm,
    alike within `gust_size` m and `gust_time` s, from `seed`.

    float32 with sums in float64. Any number of threads gives the same digits. Memory: about 100 bytes a cell of
    the grid with two cells more on each side and rows of whole 16s; 160 for a nest.
    """

    def __init__(
        self,
        levels: ArrayLike,
        shape: tuple[int, int],
        spacing: float,
        height: ArrayLike,
        potential_temperature: ArrayLike,
        wind: ArrayLike,
        *,
        water: ArrayLike | None = None,
        pressure: float = 101325.0,
        corner: tuple[float, float] = (0.0, 0.0),
        ground: ArrayLike | None = None,
        side_width: float = 8.0,
        side_time: float = 40.0,
        top: float = 0.22,
        top_time: float = 60.0,
        ground_time: float = 300.0,
        mixing: float = 0.18,
        source_depth: float = 90.0,
        gust_strength: float = 0.0,
        gust_size: float = 400.0,
        gust_time: float = 90.0,
        seed: int = 0,
    ) -> None: ...
    def nest(
        self,
        levels: ArrayLike,
        shape: tuple[int, int],
        spacing: float,
        corner: tuple[float, float],
        *,
        ground: ArrayLike | None = None,
        side_width: float = 10.0,
        side_time: float = 8.0,
        top: float = 0.22,
        top_time: float = 60.0,
        ground_time: float = 300.0,
        mixing: float = 0.18,
        source_depth: float = 90.0,
        gust_strength: float = 0.0,
        gust_size: float = 400.0,
        gust_time: float = 90.0,
        seed: int = 0,
    ) -> Solver:
        """A finer box within this one, at least two of its cells from the sides, that begins as this flow is now.

        Step this flow first and then the nest, up to the same time: its sides follow this flow, linearly between
        its steps, and so does its wind. Nothing goes back. Both need their sources set.
        """

    def set_sources(
        self, position: ArrayLike, heat: ArrayLike, smoke: ArrayLike, water: ArrayLike | None = None
    ) -> None:
        """What burns from now on: position (n, 2) m, heat (n,) W into the air, smoke and water vapour (n,) kg/s.

        Each source goes to the four nearest columns; one that is not within the middles of the outermost cells is
        left out.
        """

    def set_wind(self, wind: ArrayLike) -> None:
        """Change the wind around (n, 2), m/s, one for each of the profile's heights; the flow moves along with it."""

    def step(self, dt: float, count: int = 1) -> None:
        """Go on by `count` steps of `dt` s; what moves is carried in substeps below Courant number 0.8.

        0.05 s per metre of `spacing` is a good step. Raises `Error` when the flow has become infinite.
        """

    @property
    def time(self) -> float:
        """Since the beginning, s."""
    @property
    def steps(self) -> int:
        """Taken since the beginning."""
    @property
    def substeps(self) -> int:
        """Of the last step."""
    @property
    def courant(self) -> float:
        """Largest Courant number of the last step as a whole."""
    @property
    def divergence(self) -> float:
        """Largest |div(density x wind)| / density that the pressure left, 1/s."""
    @property
    def levels(self) -> NDArray[np.float64]:
        """(nz + 1,) m above ground."""
    @property
    def density(self) -> NDArray[np.float64]:
        """(nz,) of the air in each level, kg/m3."""
    @property
    def spacing(self) -> float:
        """Edge of a square cell, m."""
    @property
    def corner(self) -> tuple[float, float]:
        """(x, y) of the outer corner of row 0, column 0, m."""
    @property
    def shape(self) -> tuple[int, int, int]:
        """Levels, rows, columns."""
    def smoke(self) -> NDArray[np.float32]:
        """(nz, ny, nx) smoke, kg/m3 of true air: times the cells' true volume it sums to what is airborne."""
    def age(self) -> NDArray[np.float32]:
        """(nz, ny, nx) mean time since the smoke there was given off, s; 0 without smoke."""
    def velocity(self) -> NDArray[np.float32]:
        """(nz, ny, nx, 3) wind east, north and up in cells' middles, m/s; along a slope it climbs."""
    def warmth(self) -> NDArray[np.float32]:
        """(nz, ny, nx) temperature above the ambient's at that height, K."""
    def cloud(self) -> NDArray[np.float32]:
        """(nz, ny, nx) cloud water, kg/kg."""
    def heights(self) -> NDArray[np.float32]:
        """(nz, ny, nx) of cells' middles, m, in the ground's datum."""
    def mass(self) -> dict[str, float]:
        """The smoke's account, kg: initial + emitted + entered + rounding = airborne + left."""
    def heat(self) -> dict[str, float]:
        """The heat's account, J: `given` by sources; `warmed`, the same over the Exner function where it went in;
        `held`, cp x mass x potential temperature above the ambient's. In neutral air, held = warmed until the plume
        meets the sides or the top."""
    def state(self) -> dict[str, NDArray]:
        """All that `restore` needs, as new arrays: u, v, w, theta, smoke, age, water (float32), account, wind."""
    def restore(self, state: dict[str, NDArray]) -> None:
        """Go on from a `state` of a solver made alike, to the last digit, once sources are set again.

        The state of a nest is restored after its outer flow's, both taken at the same time.
        """

class Drift:
    """How far the air in every other cell of a solver has come since its phase began.

    Noise at (place - drift) travels with the flow. Flow shears it into streaks in the end, so a phase begins anew
    every `period` s, and two of them, half a period apart, take turns (Neyret 2003, "Advected textures").
    Semi-Lagrangian, linear between. Any number of threads gives the same digits.
    """

    def __init__(self, solver: Solver, period: float = 120.0) -> None: ...
    def advance(self) -> None:
        """Go on to the solver's time with the wind that it has now: call it after each of its steps."""
    def values(self) -> NDArray[np.float32]:
        """(nz', ny', nx', 2, 3) drift of both phases east, north and up along the levels, m.

        In the middles of cells 0, 2, 4 ... along each axis.
        """
    def restore(self, time: float, values: ArrayLike) -> None:
        """Go on from values of this `time`, s."""
    @property
    def time(self) -> float:
        """Up to which it was advanced, s."""
    @property
    def weights(self) -> list[float]:
        """How much each phase shows: none where it begins and ends; their squares add up to 1."""
    @property
    def turns(self) -> list[int]:
        """How often each phase has begun."""

class Detail:
    """Smoke of a moment with detail below the cells of its flow.

    The logarithm of the smoke is raised and lowered by noise that travels with the air, and what falls below a
    threshold is cut away: crisp lumps where smoke is vigorous (rises, is warm, fresh or dense), veils elsewhere.
    The formulas and what was chosen by eye are in cpp/flow/detail.hpp, detail.cpp and detail_brush.cpp.

    Arrays are (nz, ny, nx) on square cells of `spacing` m from `corner` (x, y) m: a solver's, or a block of its
    cells that reaches down to the ground. `levels` (nz,) m are the cells' middles above ground, `heights` the same
    in the ground's datum, `ground` (ny, nx) m; `smoke` kg/m3, `age` s, `rise` m/s, `warmth` K, `drift`
    (nz, ny, nx, 2, 3) m with its `weights` and `turns`; `glow`, the light of flames in any unit, or None.

    `size` m of the largest lumps; `scale` of the fire over that of 200 m cells; `blur` of the drift along levels, rows and columns, cells; `opacity` times the
    extinction; `thickest` 1/m, where that levels off; `ages` s between which smoke turns from dark to white;
    `condensation` m, the height (in the ground's datum) from which vapour turns rising smoke white and thicker.
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
        warmth: ArrayLike,
        drift: ArrayLike,
        weights: tuple[float, float],
        turns: tuple[int, int],
        glow: ArrayLike | None = None,
        size: float = 340.0,
        blur: tuple[float, float, float] = (0.0, 0.0, 0.0),
        opacity: float = 1.0,
        thickest: float = 0.03,
        ages: tuple[float, float] = (20.0, 600.0),
        condensation: float = 1e6,
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
        """Extinction (1/m), freshness (1 young, 0 old or none) and glow of voxels (nx, ny, layers).

        `origin` is the centre of the first, `surface` (nx, ny) the height of the true ground, m, and `share`
        (nx, ny) a factor of the extinction. `wanted` says which blocks of 16 voxels along each side, the last
        ones less, are painted; left out, all are.
        """
    def paint_sparse(
        self,
        origin: tuple[float, float, float],
        voxel: float,
        surface: ArrayLike,
        share: ArrayLike,
        layers: int,
        wanted: ArrayLike | None = None,
        thinnest: float = 0.0,
    ) -> SparseSmoke:
        """The same, kept only where there is smoke; what is thinner than `thinnest` (1/m) is clear."""
