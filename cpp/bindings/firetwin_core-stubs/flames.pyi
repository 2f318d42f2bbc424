"""Flames as volumes: library of solved flames, field, samples, and OpenVDB files."""

from collections.abc import Mapping, Sequence
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .volume import VdbSummary

CORE_HEAT: float
"""Heat at which the luminance of flames is 1."""
LUMINANCE_DECADES: tuple[float, float]
"""Decades of luminance in a unit of heat, below and above the core's."""

class FlameBlock:
    """Solved fire: its mixture fraction, frame by frame.

    Lengths are over the flame length L, times over sqrt(L / g).
    """

    def __init__(
        self,
        codes: ArrayLike,
        rise: ArrayLike,
        *,
        cell: float,
        front: float,
        interval: float,
        fade: int,
        wind: float,
        periodic: bool,
        soft: bool = False,
    ) -> None:
        """Copy a block.

        Parameters
        ----------
        codes
            (frames, up, along, across) uint8, 255 sqrt(Z / 4): Z is the mixture fraction over the
            stoichiometric one.
        rise
            (up) mean speed of hot gas over sqrt(g L).
        cell
            Edge of a cell.
        front
            Place across the front of its leading edge, from the first cell's face.
        interval, fade
            Time between frames, and number of last frames that fade into the first ones.
        wind
            Wind across the front over sqrt(g L).
        periodic
            Along the front; else nothing burns beyond the sides.
        soft
            Mean of three cells, weights 1 2 1, up and across.

        Raises
        ------
        ValueError
            Shapes do not match, or there are fewer than two frames or cells along an axis.
        """

class FlameLibrary:
    """Solved fires: lines by wind, and crowns, with some blocks of each."""

    def __init__(self, lines: Sequence[Sequence[FlameBlock]], crowns: Sequence[FlameBlock]) -> None:
        """Set the blocks of each kind of line, from the calmest to the strongest wind, and of crowns.

        Raises
        ------
        ValueError
            A kind is empty, or lines are not sorted by wind.
        """

class FlameShape:
    """Wind that carries flames."""

    def __init__(self, *, wind: Sequence[float]) -> None:
        """Set the wind at the flames, m/s east and north."""

class FlameLight:
    """Light and temperature of flames by heat: 0 in the coolest part, 1 in the hottest."""

    def __init__(
        self,
        *,
        visible: ArrayLike,
        soot: float,
        soot_light: Sequence[float],
        coolest: float,
        hottest: float,
        extinction: ArrayLike,
        dim: float,
    ) -> None:
        """Set all parameters.

        Parameters
        ----------
        visible
            (n, 3) radiance at evenly spaced heats.
        soot
            Extinction of cooled soot over the flames, over a flame's.
        soot_light
            (3,) radiance of soot per unit of optical depth.
        coolest, hottest
            Temperatures at heat 0 and 1, K.
        extinction
            (k, 3) flame lengths, m, with the visible and the infrared extinction of the sootiest gas, 1/m;
            linear between, constant outside.
        dim
            Optical depth of 1 km of air in the infrared; it grows with the distance to the power 0.75.
        """

class FlameVolume:
    """Flames of one frame as a volume: a function of place and time, without stored voxels."""

    def __init__(
        self,
        *,
        patches: tuple[ArrayLike, ArrayLike, ArrayLike],
        spindles: ArrayLike,
        library: FlameLibrary,
        shape: FlameShape,
        light: FlameLight,
        pixel: float,
        fade: Sequence[float],
        origin: Sequence[float],
        time: float,
    ) -> None:
        """Set the flames of one frame.

        Parameters
        ----------
        patches
            Nodes (n, 33, 33, 8), corners (n, 2) and spacings (n) of squares of the ground, m. A place takes
            the finest patch that contains it; nothing burns outside. Rows of nodes run north. Channels:
            elevation; length of the front's flames, m; distance behind the front, m; height of low flames
            behind it, m; burning share of the ground; east and north of the direction in which the front
            moves; an unused one.
        spindles
            (n, 6) crowns in flames: x, y and z of the foot, heights of their base and top, and radius, m.
        pixel
            Size of a pixel per distance, m/m.
        fade
            Distances (m) between which flames fade out.
        origin
            A point near the camera; it improves precision only.
        time
            Model time, s.

        Raises
        ------
        ValueError
            Shapes do not match, a spacing is not positive, or patches are too far apart.
        """

    def sample(self, points: ArrayLike, fine: float = 0.0) -> NDArray[np.float32]:
        """Return extinction (1/m), visible and infrared, and temperature (K) at points (n, 3): (n, 3).

        All are 0 without flames. Detail smaller than `fine` (m) is averaged. Flames fade out with the
        distance from the origin. Cooled soot over the flames is not included.
        """

def write_flames(
    path: str | PathLike[str],
    flames: FlameVolume,
    voxel_size: float,
    *,
    metadata: Mapping[str, str] | None = None,
) -> VdbSummary:
    """Write flames as an OpenVDB file: `flames` and `infrared` (extinction, 1/m), and `temperature` (K).

    The voxels have the values of `FlameVolume.sample` at their centres, in half precision, up to the distance
    at which the flames fade out. Memory: 76 bytes per block of 8^3 voxels with flames.

    Raises
    ------
    ValueError
        voxel_size is not 1e-4 to 1e6 m.
    Error
        The voxels are far too small for the extent of the flames.
    InputError
        The folder is missing or cannot be written.
    """
