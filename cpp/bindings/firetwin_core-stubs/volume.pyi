"""Smoke volumes: OpenVDB files, light in smoke, and ray marching."""

from collections.abc import Mapping, Sequence
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .flames import FlameVolume
from .geo import LocalFrame
from .lod import ViewSet

FRESH_SMOKE: float
"""Smoke that counts as dilution 1, kg/m3."""

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
        """Mass of smoke, kg: the integral of the written smoke, before rounding to half floats.

        0 if the grid of smoke mass is not written: `dilution`, or `density` for `write`.
        """
    @property
    def culled_mass(self) -> float:
        """Mass of smoke in blocks that frustum and occlusion culling removed, kg."""

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
    """Write smoke on terrain-following levels as a sparse volume, half precision with Blosc.

    Grids: `density` (0 to 1, thick smoke), `dilution` (in units of FRESH_SMOKE), `shade` (dilution with a
    sharp edge), `size` (km, the spacing of the model's columns), `temperature` (K) and, with flames (n, 3) m
    and (n,) W, `glow` (1 among flames of 1 GW) and `flame` (GW, at most 1). See cpp/volume/grids.hpp. `grids`
    lists the grids to write (None: all). With `views`, blocks of 8^3 voxels are culled (with a margin of
    300 m); the other blocks are unchanged. The file is renamed when it is complete.

    Parameters
    ----------
    frame
        The local frame of the voxels.
    latitude, longitude
        (ny,), (nx,) degrees.
    ground
        (ny, nx) m: there is none below it; the lowest level's smoke extends down to it.
    height, smoke, temperature
        (nz, ny, nx) m, ascending with the levels; kg/m3; K (None: the standard atmosphere).

    Notes
    -----
    Linear functions of height are reproduced exactly. `density` is a smoothstep of `dilution`, as a model
    defines no surface; see cpp/volume/levels.hpp.

    Raises
    ------
    ValueError
        Shapes do not match, voxel_size is not 1e-4 to 1e6 m, or a grid name is unknown.
    Error
        Heights do not ascend, or voxels are far too small.
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
        Arrays (nx, ny, nz) by name. C-contiguous float32 arrays are not copied.
    voxel_size
        m, 1e-4 to 1e6.
    origin
        m, the centre of voxel (0, 0, 0) of every array.
    half
        Round values to half precision (nearest, ties to even), whose largest value is 65504.
    tolerance
        Values up to this magnitude become background (0). Each grid has its own active voxels.
    metadata
        Metadata of the file.
    views
        For culling: blocks of 8^3 voxels that it does not see are removed (with a margin of 300 m); the other
        blocks are unchanged. Values in culled blocks are not checked. Only `density` is summed there, for
        `VdbSummary.culled_mass`.
    within
        Name of a grid: all other grids are removed from blocks of 8^3 voxels that are empty in it. Smoke
        there would be invisible, yet renderers march through all blocks of any grid.

    Returns
    -------
    VdbSummary
        `mass` is the integral of the written `density` (kg/m3) before rounding, `culled_mass` its integral
        over culled blocks; both are 0 without a grid `density`.

    Notes
    -----
    Constant blocks become tiles, as in OpenVDB's `copyFromArray`. In addition to the arrays and the masks of
    active voxels (a few bytes per 100 values), memory use is some megabytes for blocks being written. Equal
    grids make identical files on any number of threads.

    Raises
    ------
    ValueError
        An array has the wrong shape, a value is not finite or too large for half precision, or a number is
        out of range.
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
    """Cull smoke that is occluded by smoke: voxels behind a given optical depth from every viewpoint.

    Parameters
    ----------
    extinction
        1/m, (nx, ny, nz).
    voxel_size
        m.
    places
        (n, 3) m, perspective viewpoints.
    directions
        (m, 3) unit vectors towards orthographic viewpoints (parallel lines of sight).
    depth
        Optical depth. A voxel is occluded if it exceeds this along every ray to a viewpoint.
    origin
        m, the centre of voxel (0, 0, 0).
    beyond
        `smoke` of a coarser, larger grid, as returned; it occludes too.

    Returns
    -------
    occluded
        (nx, ny, nz) 1 in occluded voxels, else 0; 0 everywhere without viewpoints.
    smoke
        Extinction (1/m) on voxels of four times the size, their size (m), and the centre of the first (m).

    Notes
    -----
    Optical depth is computed on the larger voxels by ray marching, one step per voxel, and interpolated
    linearly. Rays end a little beyond `depth`.
    """

def smoke_light(
    extinction: ArrayLike,
    voxel_size: float,
    direction: Sequence[float],
    sun_factor: float,
    sky_factor: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    beyond: LightDepths | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32], LightDepths]:
    """Compute the transmittance of sunlight and skylight in smoke.

    Parameters
    ----------
    extinction
        1/m, (nx, ny, nz).
    voxel_size
        m.
    direction
        Unit vector (x, y, z) to the sun.
    sun_factor, sky_factor
        Factors on the optical depth for sunlight and skylight.
    origin
        m, the centre of voxel (0, 0, 0).
    beyond
        `depths` of a coarser, larger grid, as returned. They are added where a ray to a light leaves this
        grid.

    Returns
    -------
    Transmittance is 1 in clear air next to smoke, 0 farther than a voxel from smoke.

    sun
        (nx, ny, nz) exp(-sun_factor * optical depth to the sun). The first four voxels of a ray are marched
        one by one. The rest is swept slice by slice from the lit side on voxels of twice the size and
        interpolated linearly. Shadow edges widen by about half a voxel times the square root of the number of
        slices.
    sky
        (nx, ny, nz) transmittance of a uniform sky: the mean over five upward directions, each representing a
        fifth of the sky, on voxels of four times the size.
    depths
        Optical depths to the sun and to the sky.
    """

class LightDepths:
    """Optical depths of smoke to the sun and to the sky, for finer smoke inside of it."""

    @property
    def sun(self) -> NDArray[np.float32]:
        """Optical depths to the sun on voxels of twice the size."""

class SparseSmoke:
    """Sparse voxel grid of smoke: blocks of 8^3 voxels; clear blocks are not stored.

    `firetwin_core.flow.Detail.paint_sparse` makes it, with extinction (1/m), freshness, and glow if there are
    flames.
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
    def dim_glow(self, part: float) -> None:
        """Dim the glow by the smoke below, as most flames are on the ground.

        Parameters
        ----------
        part
            Factor on the optical depth down to the ground. It is summed up on voxels of twice the size.
        """

class LitSmoke:
    """Sparse smoke with sunlight and skylight; `smoke_light` is the equivalent for dense smoke."""

    def __init__(
        self,
        smoke: SparseSmoke,
        direction: Sequence[float],
        sun_factor: float,
        sky_factor: float,
        beyond: LightDepths | None = None,
    ) -> None:
        """Compute optical depths; the arguments are the same as for `smoke_light`."""
    @property
    def depths(self) -> LightDepths:
        """Optical depths to the sun and to the sky."""
    def bricks(self, share: ArrayLike, min_extinction: float) -> Bricks:
        """Pack the visible share for ray marching.

        Parameters
        ----------
        share
            (nx, ny) factor on the visible extinction, 0 to 1. All of the smoke attenuates light.
        min_extinction
            1/m; smoke with a smaller visible extinction is set to clear.
        """
    def grids(self, share: ArrayLike, min_extinction: float) -> dict[str, NDArray[np.float32]]:
        """Return dense arrays (nx, ny, nz): density, fresh, sun, sky, and glow if the smoke has it."""

class Bricks:
    """Sparse voxel grid of smoke and light for ray marching; clear blocks are not stored.

    A block has 8^3 cells and the 9^3 voxels at their corners. It is stored if a voxel's extinction is above
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
        edge: ArrayLike | None = None,
    ) -> None:
        """Pack fields of one shape (nx, ny, nz).

        Parameters
        ----------
        density
            Extinction, 1/m.
        fresh
            1 in young smoke, 0 in old smoke.
        sun, sky
            Fourth root of the sunlight's transmittance, and transmittance of the skylight.
        glow
            Light of flames; None: no flames.
        voxel_size
            m.
        origin
            m, the centre of voxel (0, 0, 0).
        edge
            Position in the outline, 0 (outer side) to 1 (inner side); None: no outline.

        Raises
        ------
        ValueError
            Shapes differ, or a number is out of range.
        """

    @property
    def shape(self) -> list[int]:
        """Voxels along x, y and z."""
    @property
    def used(self) -> int:
        """Number of blocks with smoke."""
    @property
    def bytes(self) -> int:
        """Memory of the stored blocks, bytes."""

class HotGas:
    """Excess temperature of the hot gases of a fire over the air, on cells that follow the terrain."""

    def __init__(self, excess: ArrayLike, heights: ArrayLike, first: Sequence[float], spacing: float) -> None:
        """Set the cells.

        Parameters
        ----------
        excess
            (nz, ny, nx) K.
        heights
            (nz, ny, nx) elevation of the centres of cells, m.
        first, spacing
            x and y of the centre of the first cell, and the distance between cells, m.
        """

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
        air: Sequence[float],
        horizon: Sequence[float],
        thick_haze: Sequence[float],
        haze: Sequence[float],
        haze_height: Sequence[float],
    ) -> None:
        """Set all parameters.

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
            g of the Henyey-Greenstein phase function.
        multiple_scattering
            Weights of light scattered two and three times, relative to single scattering.
        glow
            Radiance where the field `glow` is 1; black: no glow.
        thin
            Share of the glow that smoke without other smoke around it scatters. It rises to 1 inside thick
            smoke, where no skylight arrives.
        air, horizon
            Radiance of thin and of thick haze.
        thick_haze
            Optical depths between which the haze changes from `air` to `horizon`.
        haze, haze_height
            Extinction (1/m) at height 0 of two layers of haze, and their e-folding heights (m).
        """

def flame_distance(
    flames: FlameVolume, origins: ArrayLike, directions: ArrayLike, farthest: float
) -> NDArray[np.float32]:
    """Measure the distance of flames along rays, in clear air.

    Parameters
    ----------
    origins
        (n, 3) m, or (3,) if all rays start at one point.
    directions
        (n, 3) unit vectors.
    farthest
        Length of the rays, m.

    Returns
    -------
    (n, 2) distance within which half of the flames' red light is emitted, m, and the radiance of that light;
    0 without flames.
    """

def march(
    layers: Sequence[Bricks],
    origins: ArrayLike,
    directions: ArrayLike,
    distances: ArrayLike,
    light: Illumination,
    step: float = 0.5,
    min_transmittance: float = 1.0e-3,
    flames: FlameVolume | None = None,
    pixel: Sequence[float] = (0.0, 0.0),
    parts: bool = False,
) -> NDArray[np.float32]:
    """March rays through smoke and flames: their radiance, and transmittance of the background.

    Parameters
    ----------
    layers
        At most four; their smoke adds up.
    origins
        (n, 3) m, or (3,) if all rays start at one point.
    directions
        (n, 3) unit vectors.
    distances
        (n, taps) m, in any order: distances at which a ray's result is returned; infinity: behind all smoke.
    step
        Step length, in voxels of the finest layer at each point.
    min_transmittance
        Transmittance at which a ray ends. The remaining radiance is extrapolated from the same smoke.
    flames
        Flames of the frame.
    pixel
        Width of a pixel at distance 0 (m), and its increase per m of distance. Outlines of smoke are as sharp
        as pixels show, and have noise below the voxel down to four pixels. Zeros: neither.
    parts
        Return four more values.

    Returns
    -------
    (n, taps, 4) radiance of red, green and blue, and transmittance. With `parts` (n, taps, 8): also the
    radiance of flames within the first three, and the transmittance of smoke alone.

    Notes
    -----
    Single scattering follows L. G. Henyey and J. L. Greenstein (1941); multiple scattering is approximated
    after M. Wrenninge, C. Kulla and V. Lundqvist (2013, "Oz: The Great and Volumetric"). Steps are even
    within a block and have no jitter. In the example's smoke, steps of half a voxel differ by 0.1 % from
    steps of a quarter.

    Raises
    ------
    ValueError
        Shapes do not match, or there are more than four layers.
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
    flames: FlameVolume | None = None,
    hot: Sequence[HotGas] = (),
    gas: float = 0.0,
) -> NDArray[np.float32]:
    """March rays in the infrared: smoke, hot gases and flames absorb and emit, and do not scatter.

    Parameters
    ----------
    layers, origins, directions, step, flames
        As in `march`. Temperatures of flames must be within the table of radiance.
    distances
        (n,) m, length of each ray.
    kelvin, elevation
        (rows, columns) air temperature at the model's ground, K, and elevation of that ground, m; rows to the
        north.
    corner, spacing
        x and y of the first of these values, and the distance between values, m.
    lapse
        Lapse rate above that ground, K/m.
    radiance
        (k,) black-body radiance at `coldest` K and at every `kelvin_step` K above it, W m-2 sr-1.
    absorption
        Infrared absorption / extinction in green light.
    hot
        Hot gases, the finest last: the last one that has an excess at a place counts.
    gas
        Absorption of hot gases where smoke is visible, 1/(m K).

    Returns
    -------
    (n, 2) radiance, W m-2 sr-1, and transmittance.

    Raises
    ------
    ValueError
        Shapes do not match.
    """

def opaque_distance(
    layers: Sequence[Bricks], origins: ArrayLike, directions: ArrayLike, step: float, depth: float
) -> NDArray[np.float32]:
    """Compute the distance (n,) along rays at which smoke becomes opaque, m; infinity if it never does.

    Parameters
    ----------
    layers, origins, directions, step
        As in `optical_depth`.
    depth
        Optical depth, in green light, at which smoke is opaque. Blocks of smoke count as a whole, so distances
        are up to the length of a block too long.
    """

def optical_depth(
    layers: Sequence[Bricks],
    origins: ArrayLike,
    directions: ArrayLike,
    distances: ArrayLike,
    step: float = 2.0,
    max_depth: float = 20.0,
) -> NDArray[np.float32]:
    """Compute the optical depth (n,) of smoke along rays, in green light.

    Parameters
    ----------
    layers, origins, directions, step, flames
        As in `march`. Temperatures of flames must be within the table of radiance.
    distances
        (n,) m, length of each ray.
    max_depth
        Optical depth at which a ray ends.

    Raises
    ------
    ValueError
        Shapes do not match.
    """
