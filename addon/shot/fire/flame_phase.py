"""Height of flames at a place over time, relative to their full length.

Needs no Blender.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..terrain import noise

_TALL_PART = 1.0 / 3.0  # fraction of the residence time at full height
_DEEP = 0.35  # least depth of the tall part over the flame length: that of the fuel of solved fronts
_LONGEST = 900.0  # s
_RISING = 0.12  # fraction of the tall phase in which flames grow (by eye)
_LOW = 0.22  # height behind the tall phase (by eye)
_RESIDUAL = (0.12, 1.5)  # residual flames: fraction of the length, and at most, m (by eye)
_WOOD = (20.0, 60.0)  # s, residence times from which fuel leaves residual flames; grass burns out (assumed)
_ENDS = 1.3, 1.8  # of flames over the burning time; of residual flames after it over the residence time
_LEAST = 0.1  # m, for divisions

_BEGIN = (0.25, 0.4)  # distances behind the front, flame lengths, between which low flames begin
_SHARES = 0.35, 0.08  # length of low flames over the full length: at the front; of burned fuel (by eye)
_MOST_LOW = 5.0  # m, length of low flames: under burned crowns the surface burns on (by eye)
_PATCHES = 2.2  # length of low flames over the noise of patches; half of the ground glows only (by eye)

Array = NDArray[np.float64]


def height(age: Array, speed: Array, residence: Array, length: Array, patch: Array) -> Array:
    """Return the height of flames (n,) of an age (s) as a share of their full height.

    Parameters
    ----------
    speed, residence
        Rate of spread (m/s) and residence time of the fuel (s).
    length
        Full flame length, m.
    patch
        Noise of patches that burn on behind the front.
    """
    tall, out = times(speed, residence, length)
    up = np.clip(age / (_RISING * tall), 0.0, 1.0)
    down = 1.0 - (1.0 - _LOW) * noise.smoothstep(0.0, 1.0, (age - tall) / (out - tall))
    fuel = np.clip(0.45 + 1.2 * patch, 0.0, 1.2)  # fuel behind the leading flames burns in patches
    down *= 1.0 + (fuel - 1.0) * noise.smoothstep(0.3, 1.0, age / tall)
    main = up * (2.0 - up) * down * (1.0 - noise.smoothstep(1.0, _ENDS[0], age / out))
    return np.where(age > 0.0, np.maximum(main, _residual(age - out, residence, length, patch)), 0.0)


def low(age: Array, distance: Array, speed: Array, residence: Array, length: Array, patch: Array) -> Array:
    """Return the length of flames (n,) that burn on behind the front, as a share of the full length.

    Half of the ground there only glows.

    Parameters
    ----------
    distance
        Distance behind the front, m. For the others see `height`.
    """
    _tall, out = times(speed, residence, length)
    first, last = _SHARES
    main = first + (last - first) * noise.smoothstep(0.0, 1.0, age / out)
    main = np.minimum(main, _MOST_LOW / np.maximum(length, _LEAST))
    main *= np.clip(_PATCHES * patch, 0.0, 1.2) * (1.0 - noise.smoothstep(1.0, _ENDS[0], age / out))
    residual = _residual(age - out, residence, length, patch)
    return np.maximum(main, residual) * noise.smoothstep(*_BEGIN, distance / np.maximum(length, _LEAST))


def is_behind(distance: Array, length: Array) -> NDArray[np.bool_]:
    """Return a mask (n,) of places so far behind the front (m) that flames may be low there."""
    return distance > _BEGIN[0] * length


def last_age(speed: Array, residence: Array, length: Array) -> Array:
    """Return the age (s) from which no place with flames of at most this length (m) burns."""
    _tall, out = times(speed, residence, length)
    late = np.where(residence > _WOOD[0], out + _ENDS[1] * residence, 0.0)
    return np.maximum(_ENDS[0] * out, late)


def times(speed: Array, residence: Array, length: Array) -> tuple[Array, Array]:
    """Return the ages (s) up to which flames are tall, and at which they are out but for residual ones."""
    tall = np.clip(_DEEP * length / speed, _TALL_PART * residence, _LONGEST)
    return tall, np.maximum(residence, 1.6 * tall)


def _residual(since: Array, residence: Array, length: Array, patch: Array) -> Array:
    """Return the share of residual flames, by the time (s) since others are out."""
    share = np.minimum(_RESIDUAL[0], _RESIDUAL[1] / np.maximum(length, _LEAST))
    late = since / residence
    residual = share * np.exp(-np.clip(late, 0.0, 9.0)) * np.clip(2.0 * patch - 0.8, 0.0, 1.0)
    residual *= (late > -0.5) * (1.0 - noise.smoothstep(1.2, _ENDS[1], late))
    return residual * noise.smoothstep(*_WOOD, residence)
