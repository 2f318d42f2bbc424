"""Smoke volumes: OpenVDB files, light in smoke, and ray marching."""

from collections.abc import Mapping, Sequence
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import LocalFrame
from .lod import ViewSet

FRESH_SMOKE: float
"""Smoke that counts as dilution 1, kg/m3."""

class Puffs:
    """Gaussian-puff smoke at one time as n balls. It has a closed form in time: no earlier state is needed."""

    @property
    def position(self) -> NDArray[np.float32]:
        """(n, 3) metres."""
    @property
    def radius(self) -> NDArray[np.float32]:
        """(n,) metres."""
    @property
    def density(self) -> NDArray[np.float32]:
        """(n,) smoke density of the puff, kg/m3; a surface ball has its parent's."""
    @property
    def age(self) -> NDArray[np.float32]:
        """(n,) seconds."""
    @property
    def mass(self) -> NDArray[np.float64]:
        """(n,) kg of smoke; 0 for the balls that shape the surface of a puff."""
    @property
    def identity(self) -> NDArray[np.uint64]:
        """(n,) identifier of a ball, constant in time."""
    @property
    def emitted(self) -> float:
        """kg of smoke emitted up to this time."""
    @property
    def left(self) -> float:
        """kg of smoke that is too old or too thin to be shown: emitted = sum of mass + left."""
    def __len__(self) -> int: ...

def puffs(
    time: float,
    arrival: ArrayLike,
    fuel: ArrayLike,
    position: ArrayLike,
    wind: ArrayLike,
    cell_area: float,
    interval: float = 60.0,
    max_age: float = 5400.0,
    burn_time: float = 600.0,
    stability: float = 1.0e-4,
    seed: int = 0,
    smoke_fraction: float = 0.02,
    heat_of_combustion: float = 17.433e6,
    block: float = 400.0,
    merge_radius: float = 2000.0,
    smallest: float = 50.0,
    turbulence: float = 1.0,
) -> Puffs:
    """Closed-form puffs at `time` (s) from cells that burned.

    Parameters
    ----------
    arrival, fuel, position
        (n,) s, (n,) kg/m2 consumed and (n, 3) m; finite: leave out cells that never burn.
    wind
        (n, 2), or what broadcasts to it, m/s east and north 10 m above the ground, when the cell burned.
    cell_area
        m2.
    interval
        s of emission that make one puff.
    burn_time
        s in which a cell burns out.
    stability
        Square of the buoyancy frequency, 1/s2.
    block, merge_radius, smallest
        m: side of the squares whose cells share a puff; distance over which plumes rise as one; radius of the
        smallest surface ball.
    turbulence
        0 keeps every puff on the axis of its plume.

    Notes
    -----
    Rise after Briggs (1969, 1984), see cpp/volume/plume.hpp; growth, stems and surface balls, see
    cpp/volume/puffs.hpp.

    Raises
    ------
    ValueError
        An array has the wrong shape or holds NaN, or a number is not positive.
    """

class VdbSummary:
    """Summary of one VDB file."""

    @property
    def active_voxels(self) -> int:
        """Active voxels of the grid that has the most."""
    @property
    def voxels(self) -> int:
        """Active voxels of all grids together."""
    @property
    def bytes(self) -> int:
        """Size of the file, bytes."""
    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) metres, world space; zeros for an empty file."""
    @property
    def mass(self) -> float:
        """kg of smoke: the integral of what is written, before it is rounded to half floats.

        0 where its grid, `dilution` or that of `write`, `density`, is not written.
        """
    @property
    def culled_mass(self) -> float:
        """kg of smoke in blocks that frustum and occlusion culling removed."""

def write_smoke(
    path: str | PathLike[str],
    puffs: Puffs,
    voxel_size: float,
    flame_position: ArrayLike | None = None,
    flame_power: ArrayLike | None = None,
    metadata: Mapping[str, str] | None = None,
    grids: Sequence[str] | None = None,
    views: ViewSet | None = None,
) -> VdbSummary:
    """Write puffs as a sparse volume, half precision with Blosc, to a temporary file that is then renamed.

    Grids: `density` (clipped signed distance (m + 300) / 600), `dilution` (in units of FRESH_SMOKE), `shade`
    (dilution with a plain edge), `size` (km, of the local ball), `temperature` (K) and, with flames (n, 3) m
    and (n,) W, `glow` (1 amid 1 GW) and `flame` (GW, at most 1). See cpp/volume/smoke.hpp. `grids` names those
    that are wanted (None: all). With `views`, blocks of 8^3 voxels are culled (with a margin of 300 m); the other
    blocks are the same as without.

    Raises
    ------
    ValueError
        An array has the wrong shape, voxel_size is not 1e-4 to 1e6 m, or no grid has such a name.
    Error
        The voxels are far too small for smoke this wide.
    InputError
        The folder is missing or cannot be written.
    """

def write_levels(
    path: str | PathLike[str],
    frame: LocalFrame,
    latitude: ArrayLike,
    longitude: ArrayLike,
    ground: ArrayLike,
    height: ArrayLike,
    smoke: ArrayLike,
    voxel_size: float,
    temperature: ArrayLike | None = None,
    flame_position: ArrayLike | None = None,
    flame_power: ArrayLike | None = None,
    metadata: Mapping[str, str] | None = None,
    grids: Sequence[str] | None = None,
    views: ViewSet | None = None,
) -> VdbSummary:
    """Write smoke on terrain-following levels as a volume with the grids of `write_smoke`.

    Parameters
    ----------
    frame
        The local frame of the voxels.
    latitude, longitude
        (ny,), (nx,) degrees.
    ground
        (ny, nx) m: under it there is no smoke; the lowest level's smoke reaches down to it.
    height, smoke, temperature
        (nz, ny, nx) m, ascending with the levels; kg/m3; K, without it that of the standard atmosphere.

    Notes
    -----
    Linear functions of height are kept exactly. `density` is a smoothstep of `dilution`, for a model gives
    no surface; see cpp/volume/levels.hpp.

    Raises
    ------
    ValueError
        Shapes that do not fit, voxel_size is not 1e-4 to 1e6 m, or no grid has such a name.
    Error
        Heights that do not ascend, or voxels far too small.
    InputError
        The folder is missing or cannot be written.
    """

def write(
    path: str | PathLike[str],
    grids: Mapping[str, ArrayLike],
    voxel_size: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    half: bool = True,
    tolerance: float = 0.0,
    metadata: Mapping[str, str] | None = None,
    views: ViewSet | None = None,
    within: str = "",
) -> VdbSummary:
    """Write dense arrays as sparse fog volumes of cubic voxels, to a temporary file that is then renamed.

    Parameters
    ----------
    grids
        Arrays (nx, ny, nz) by name. Those of float32 in C order are read where they are, others are copied.
    voxel_size
        m, 1e-4 to 1e6.
    origin
        m, the centre of voxel (0, 0, 0) of every array.
    half
        Whether values are rounded to half precision (nearest, ties to even), which holds them up to 65504.
    tolerance
        Values this near 0, the background, are left out. Each grid has its own active voxels.
    metadata
        What the file says of itself.
    views
        Blocks of 8^3 voxels are culled (with a margin of 300 m); the other blocks are the same as without. Values
        in culled blocks are not checked. Only `density` is summed there, for `VdbSummary.culled_mass`.
    within
        Name of a grid: the others are left out of blocks of 8^3 voxels where it has nothing. Of smoke nothing is seen
        there, yet renderers go step by step through all blocks that any grid has.

    Returns
    -------
    VdbSummary
        `mass` is the integral of what is written of `density`, read as kg/m3, before rounding, `hidden` of what
        is left out because no camera sees it; both 0 without a grid of that name.

    Notes
    -----
    Blocks of one value become tiles, as in OpenVDB's `copyFromArray`. Beside the arrays and the masks of active
    voxels (a few bytes for 100 values) memory holds some megabytes of what is on its way to the file. The same
    grids make the same bytes on any number of threads.

    Raises
    ------
    ValueError
        An array has the wrong shape, a value is not finite or too large for half precision, or a number makes
        no sense.
    InputError
        The folder is missing or cannot be written.
    """

def occluded_smoke(
    extinction: ArrayLike,
    voxel_size: float,
    places: ArrayLike,
    directions: ArrayLike,
    depth: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    beyond: tuple[ArrayLike, float, Sequence[float]] | None = None,
) -> tuple[NDArray[np.float32], tuple[NDArray[np.float32], float, list[float]]]:
    """Occlusion culling of smoke by smoke: voxels behind a given optical depth from every viewpoint.

    Parameters
    ----------
    extinction
        1/m, (nx, ny, nz).
    voxel_size
        m.
    places
        (n, 3) m, perspective viewpoints.
    directions
        (m, 3) unit vectors to orthographic viewpoints (parallel lines of sight).
    depth
        Optical depth. A voxel is occluded if every ray from it to a viewpoint has more than that.
    origin
        m, the centre of voxel (0, 0, 0).
    beyond
        `smoke` of a coarser, larger grid, as returned; it occludes too.

    Returns
    -------
    occluded
        (nx, ny, nz) 1 where smoke is occluded, else 0; 0 everywhere without viewpoints.
    smoke
        Extinction (1/m) on voxels of four times the size, that size (m), and the centre of the first (m).

    Notes
    -----
    Optical depth is found on the larger voxels by ray marching, one step a voxel, and is linear between them.
    Rays end a little beyond `depth`.
    """

def smoke_light(
    extinction: ArrayLike,
    voxel_size: float,
    direction: Sequence[float],
    sun_part: float,
    sky_part: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    beyond: tuple[ArrayLike, float, Sequence[float]] | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32], tuple[NDArray[np.float32], float, list[float]]]:
    """Sunlight and skylight in smoke (transmittance): 1 in clear air beside smoke, 0 farther than a voxel from it.

    Parameters
    ----------
    extinction
        1/m, (nx, ny, nz).
    voxel_size
        m.
    direction
        Unit vector (x, y, z) to the sun.
    sun_part, sky_part
        Factors on the optical depth for sunlight and skylight.
    origin
        m, the centre of voxel (0, 0, 0).
    beyond
        `depths` of a coarser, larger grid, as returned. They are added where a ray to the sun leaves this grid.

    Returns
    -------
    sun
        (nx, ny, nz) exp(-sun_part * optical depth to the sun). The first four voxels of a ray are marched one by
        one. The rest is swept slice by slice from the lit side on voxels of twice the size, linear between. A
        shadow's edge widens by about half a voxel times the root of the number of slices.
    sky
        (nx, ny, nz) transmittance of a uniform sky: the mean over five upward directions, each for a fifth of
        the sky, on voxels of four times the size.
    depths
        Optical depths to the sun on voxels of twice the size, that size (m), and the centre of the first (m).
    """

class SparseSmoke:
    """Sparse voxel grid of smoke: blocks of 8^3 voxels; clear blocks are not stored.

    `firetwin_core.flow.Detail.paint_sparse` makes it: extinction (1/m), freshness, and a glow if there is one.
    """

    @property
    def voxel_size(self) -> float:
        """Edge of a voxel, m."""
    @property
    def origin(self) -> list[float]:
        """Centre of voxel (0, 0, 0), m."""
    @property
    def shape(self) -> list[int]:
        """Voxels along x, y and z."""
    @property
    def used(self) -> int:
        """Number of stored blocks."""

class LitSmoke:
    """Sparse smoke with sunlight and skylight in it; `smoke_light` is the same for dense smoke."""

    def __init__(
        self,
        smoke: SparseSmoke,
        direction: Sequence[float],
        sun_part: float,
        sky_part: float,
        beyond: tuple[ArrayLike, float, Sequence[float]] | None = None,
    ) -> None:
        """Compute optical depths; the arguments are those of `smoke_light`."""
    @property
    def depths(self) -> tuple[NDArray[np.float32], float, list[float]]:
        """Optical depths to the sun, as `smoke_light` returns them."""
    def bricks(self, share: ArrayLike, min_extinction: float) -> Bricks:
        """Pack the drawn part for ray marching.

        Parameters
        ----------
        share
            (nx, ny) factor on the drawn extinction, 0 to 1. Light is dimmed by all of the smoke.
        min_extinction
            1/m; smoke with a smaller extinction after that is clear.
        """
    def grids(self, share: ArrayLike, min_extinction: float) -> dict[str, NDArray[np.float32]]:
        """The same as dense arrays (nx, ny, nz): density, fresh, sun, sky, and glow where the smoke has one."""

class Bricks:
    """Sparse voxel grid of smoke and light for ray marching; clear blocks are not stored.

    A block has 8^3 cells and the 9^3 voxels at their corners. Blocks are stored where extinction is above
    2.5e-5 /m. Values are half floats: the error is at most 1/2048 of the value plus 3e-8.
    """

    def __init__(
        self,
        density: ArrayLike,
        fresh: ArrayLike,
        sun: ArrayLike,
        sky: ArrayLike,
        glow: ArrayLike | None,
        voxel_size: float,
        origin: Sequence[float],
    ) -> None:
        """Pack fields of one shape (nx, ny, nz).

        Parameters
        ----------
        density
            Extinction, 1/m.
        fresh
            1 where smoke is young, 0 where it is old.
        sun, sky
            As `smoke_light` gives them.
        glow
            Light of flames; None: none.
        voxel_size
            m.
        origin
            m, the centre of voxel (0, 0, 0).

        Raises
        ------
        ValueError
            Shapes differ, or a number makes no sense.
        """

    @property
    def shape(self) -> list[int]:
        """Voxels along x, y and z."""
    @property
    def used(self) -> int:
        """Number of blocks with smoke."""
    @property
    def bytes(self) -> int:
        """Memory of these blocks, bytes."""

class Illumination:
    """Light sources of `march`: sun, sky, flames and haze, with the smoke's albedo. Colours are linear."""

    def __init__(
        self,
        *,
        density: float,
        fresh: Sequence[float],
        old: Sequence[float],
        sun: Sequence[float],
        sky: Sequence[float],
        sun_direction: Sequence[float],
        anisotropy: float,
        multiple_scattering: Sequence[float],
        glow: Sequence[float],
        thin: float,
        thick: Sequence[float],
        air: Sequence[float],
        haze: float,
        haze_height: float,
    ) -> None:
        """Set all of it.

        Parameters
        ----------
        density
            Factor on the extinction.
        fresh, old
            Albedo of young and of old smoke.
        sun
            Irradiance of the sun.
        sky
            Mean radiance of the sky over all directions.
        sun_direction
            Unit vector to the sun.
        anisotropy
            g of Henyey and Greenstein's phase function.
        multiple_scattering
            Multiple scattering: weights of light scattered twice and thrice, relative to single scattering.
        glow
            Radiance where `glow` is 1; black has no glow.
        thin, thick
            Part of the glow that thin smoke scatters, and the extinctions (1/m) between which this part rises to 1.
        air, haze, haze_height
            Radiance of the haze, its extinction (1/m) at height 0, and its e-folding height (m).
        """

def march(
    layers: Sequence[Bricks],
    origins: ArrayLike,
    directions: ArrayLike,
    distances: ArrayLike,
    light: Illumination,
    step: float = 0.5,
    stop: float = 1.0e-3,
) -> NDArray[np.float32]:
    """Ray marching: radiance that smoke adds to rays, and the transmittance of the background.

    Parameters
    ----------
    layers
        At most four, whose smoke adds up.
    origins
        (n, 3) m, or (3,) where all rays begin in one place.
    directions
        (n, 3) unit vectors.
    distances
        (n, taps) m, in any order: distances at which a ray's result is returned. Infinity is behind all smoke.
    step
        Step length, voxels of the finest layer at the place.
    stop
        Transmittance at which a ray ends. The remaining light is extrapolated from the same smoke.

    Returns
    -------
    (n, taps, 4) radiance of red, green and blue, and transmittance.

    Notes
    -----
    Light scattered once is spread after L. G. Henyey and J. L. Greenstein (1941); more is added after
    M. Wrenninge, C. Kulla and V. Lundqvist (2013, "Oz: The Great and Volumetric"). Steps are even within a
    block and have no jitter; of the example's smoke half a voxel is 0.1 % off a quarter of it.

    Raises
    ------
    ValueError
        Shapes do not fit, or there are more than four layers.
    """

def march_infrared(
    layers: Sequence[Bricks],
    origins: ArrayLike,
    directions: ArrayLike,
    distances: ArrayLike,
    *,
    kelvin: ArrayLike,
    elevation: ArrayLike,
    corner: Sequence[float],
    spacing: Sequence[float],
    lapse: float,
    radiance: ArrayLike,
    coldest: float,
    kelvin_step: float,
    absorption: float,
    step: float = 4.0,
) -> NDArray[np.float32]:
    """Ray marching in the infrared: smoke absorbs and emits, and does not scatter.

    Parameters
    ----------
    layers, origins, directions, step
        As of `march`.
    distances
        (n,) m, how far each ray goes.
    kelvin, elevation
        (rows, columns) air temperature at the model's ground, K, and elevation of that ground, m; rows to the north.
    corner, spacing
        x and y of the first of these values, and of the distance between values, m.
    lapse
        Lapse rate above that ground, K/m.
    radiance
        (k,) W m-2 sr-1 of a black body at `coldest` K and every `kelvin_step` K from there on.
    absorption
        Infrared absorption over the extinction in green light.

    Returns
    -------
    (n, 2) radiance, W m-2 sr-1, and transmittance.

    Raises
    ------
    ValueError
        Shapes do not fit.
    """

def optical_depth(
    layers: Sequence[Bricks],
    origins: ArrayLike,
    directions: ArrayLike,
    distances: ArrayLike,
    step: float = 2.0,
    enough: float = 20.0,
) -> NDArray[np.float32]:
    """Optical depth of smoke along rays in green light, (n,). A ray ends at the optical depth `enough`.

    Parameters
    ----------
    layers, origins, directions, step
        As of `march`.
    distances
        (n,) m, how far each ray goes.

    Raises
    ------
    ValueError
        Shapes do not fit.
    """
