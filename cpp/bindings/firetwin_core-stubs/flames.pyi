"""Flames as volumes: field of flames, samples, and OpenVDB files."""

from collections.abc import Mapping, Sequence
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .volume import VdbSummary

class FlameShape:
    """Shape of flames; the numbers are chosen by eye."""

    def __init__(
        self,
        *,
        wind: Sequence[float],
        fill: float = 0.9,
        taper: float = 0.95,
        ragged: float = 2.3,
        edge: float = 0.22,
        roll: float = 0.17,
        broken: float = 0.6,
    ) -> None:
        """Set all parameters.

        Parameters
        ----------
        wind
            Speed at which rising gas is carried, m/s east and north.
        fill, taper, ragged
            Value at the foot of a flame (it burns above 0), its decrease over the flame's length, and the
            strength of the noise.
        edge
            Values from 0 over which a flame becomes opaque.
        roll
            Displacement by eddies relative to their size.
        broken
            Strength of gaps at the foot, where fuel is gone.
        """

class FlameLight:
    """Light and temperature of flames by heat: 0 in the coolest part, 1 in the hottest."""

    def __init__(
        self,
        *,
        visible: ArrayLike,
        extinction: float,
        soot: float,
        soot_light: Sequence[float],
        coolest: float,
        hottest: float,
        scales: Sequence[Sequence[float]],
        infrared: float,
        dim: float,
    ) -> None:
        """Set all parameters.

        Parameters
        ----------
        visible
            (n, 3) radiance at evenly spaced heats.
        extinction, soot
            Extinction of flames, and of the cooled soot over them, 1/m.
        soot_light
            (3,) radiance of soot per unit of optical depth.
        coolest, hottest
            Temperatures at heat 0 and 1, K.
        scales
            (k, 3) flame lengths, m, with factors on the visible and the infrared extinction of flames; linear
            between, constant outside.
        infrared
            Infrared extinction of flames, 1/m.
        dim
            Optical depth of 1 km of air in the infrared; it grows with the distance to the power 0.75.
        """

class FlameVolume:
    """Flames of one frame as a volume: a function of place and time, without stored voxels."""

    def __init__(
        self,
        *,
        squares: Sequence[tuple[ArrayLike, ArrayLike, Sequence[float], float]],
        spindles: ArrayLike,
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
        squares
            Nested squares, finest first: (rows, columns) flame length and height of the ground, m, x and y of
            the first value, and the distance between values, m. Rows run north. A place takes the first
            square that contains it; nothing burns outside.
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
            Shapes do not match.
        """

    def sample(self, points: ArrayLike, fine: float = 0.0) -> NDArray[np.float32]:
        """Return extinction (1/m), visible and infrared, and temperature (K) at points (n, 3): (n, 3).

        All are 0 without flames. Eddies smaller than `fine` (m) are left out. Flames fade out with the
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
