"""Zooming flights: the shortest path through height and distance as the eye feels them.

J. J. van Wijk and W. A. A. Nuij, Smooth and efficient zooming and panning, IEEE Symposium on Information
Visualization 2003, doi 10.1109/INFVIS.2003.1249004, eqs. 6 to 9: the picture's movement on the screen has
one speed, whether the view comes nearer or moves across.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_BEND = 1.42  # their rho, which users in their experiment preferred
_LEAST = 1e-7  # least distance, in widths; nearer places are one


def flight(distance: Array, begin: Array, end: Array, part: Array) -> tuple[Array, Array]:
    """Point of a flight, for n flights.

    Parameters
    ----------
    distance, begin, end
        (n,) distance to fly, m, and visible width of the ground at both ends, m.
    part
        (n,) part of the flight that is done, 0 to 1; of its length as it is felt.

    Returns
    -------
    (n,) part of the distance, 0 to 1, and (n,) visible width, m.
    """
    square = _BEND * _BEND
    flown = np.maximum(distance, _LEAST * np.minimum(begin, end))
    change, across = end**2 - begin**2, square * square * flown**2
    first = -np.arcsinh((change + across) / (2.0 * begin * square * flown))
    last = -np.arcsinh((change - across) / (2.0 * end * square * flown))
    step = part * (last - first)
    width = begin * np.cosh(first) / np.cosh(first + step)
    share = begin / square * np.sinh(step) / np.cosh(first + step) / flown
    return np.clip(np.where(part >= 1.0, 1.0, share), 0.0, 1.0), np.where(part >= 1.0, end, width)


def eased(part: ArrayLike, ramp: float = 0.2) -> Array:
    """Progress 0 to 1 that gathers speed over the first `ramp` and loses it over the last, else even.

    Its speed is a smoothstep at both ends, so that it and its first derivative have no jump.
    """
    part = np.clip(np.asarray(part, np.float64), 0.0, 1.0)

    def gathered(x: Array) -> Array:
        x = np.minimum(x / ramp, 1.0)
        return ramp * (x**3 - 0.5 * x**4)

    even = np.clip(part - ramp, 0.0, 1.0 - 2.0 * ramp)
    last = gathered(np.array(ramp)) - gathered(1.0 - np.maximum(part, 1.0 - ramp))
    return np.where(part < 1.0, (gathered(part) + even + last) / (1.0 - ramp), 1.0)
