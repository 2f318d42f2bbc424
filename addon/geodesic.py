"""Geodesics on the WGS84 ellipsoid (Vincenty 1975, Survey Review 23 (176), 88-93; within 0.1 mm).

The inverse formula does not converge for nearly antipodal points (more than about 179.4 degrees apart).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .ellipsoid import E2, A

Array = NDArray[np.float64]

_F = 1.0 - np.sqrt(1.0 - E2)
_B = A * (1.0 - _F)
_ROUNDS, _SAME = 100, 1e-13  # maximum iterations, and convergence tolerance, radians


def inverse(
    latitude: ArrayLike, longitude: ArrayLike, to_latitude: ArrayLike, to_longitude: ArrayLike
) -> tuple[Array, Array, Array]:
    """Compute geodesics (n,) between points, in degrees.

    Returns
    -------
    Lengths, m, and azimuths at the first and last points, degrees clockwise from north; NaN for nearly
    antipodal points. The azimuth of a geodesic of zero length is 0.
    """
    u1, u2 = (_reduced(each) for each in np.broadcast_arrays(latitude, to_latitude))
    away = np.radians(np.asarray(to_longitude, float) - np.asarray(longitude, float))
    away = np.broadcast_to(np.arctan2(np.sin(away), np.cos(away)), u1.shape)
    s1, c1, s2, c2 = np.sin(u1), np.cos(u1), np.sin(u2), np.cos(u2)
    turn, changed = away, np.full(u1.shape, np.inf)
    for _ in range(_ROUNDS):
        sine = np.hypot(c2 * np.sin(turn), c1 * s2 - s1 * c2 * np.cos(turn))
        cosine = s1 * s2 + c1 * c2 * np.cos(turn)
        sigma = np.arctan2(sine, cosine)
        at_equator = np.divide(c1 * c2 * np.sin(turn), sine, out=np.zeros_like(sine), where=sine > 0.0)
        square = 1.0 - at_equator**2
        middle = np.divide(2.0 * s1 * s2, square, out=np.zeros_like(sine), where=square > 1e-15)
        middle = np.where(square > 1e-15, cosine - middle, 0.0)
        new = away + _longitude(at_equator, square, sigma, sine, cosine, middle)
        changed, turn = np.abs(new - turn), new
        if np.all(changed < _SAME):
            break
    length = _B * _series(square)[0] * (sigma - _arc(square, sine, cosine, middle))
    first = np.arctan2(c2 * np.sin(turn), c1 * s2 - s1 * c2 * np.cos(turn))
    last = np.arctan2(c1 * np.sin(turn), -s1 * c2 + c1 * s2 * np.cos(turn))
    bad = (changed > 1e-9) | (np.abs(turn) > np.pi)
    return tuple(np.where(bad, np.nan, each) for each in (length, np.degrees(first), np.degrees(last)))  # type: ignore[return-value]


def direct(
    latitude: ArrayLike, longitude: ArrayLike, azimuth: ArrayLike, length: ArrayLike
) -> tuple[Array, Array, Array]:
    """Compute end points (n,) of geodesics from points (degrees), azimuths (degrees) and lengths (m).

    Returns
    -------
    Latitude, longitude and azimuth at the end, degrees; longitudes are within 360 degrees of the start.
    """
    latitude, longitude, azimuth, length = (
        np.asarray(each, float) for each in np.broadcast_arrays(latitude, longitude, azimuth, length)
    )
    u, a = _reduced(latitude), np.radians(azimuth)
    su, cu, sa, ca = np.sin(u), np.cos(u), np.sin(a), np.cos(a)
    start = np.arctan2(su, cu * ca)
    at_equator = cu * sa
    square = 1.0 - at_equator**2
    plain = length / (_B * _series(square)[0])
    sigma = plain
    for _ in range(_ROUNDS):
        middle = np.cos(2.0 * start + sigma)
        sine, cosine = np.sin(sigma), np.cos(sigma)
        new = plain + _arc(square, sine, cosine, middle)
        done = np.all(np.abs(new - sigma) < _SAME)
        sigma = new
        if done:
            break
    sine, cosine, middle = np.sin(sigma), np.cos(sigma), np.cos(2.0 * start + sigma)
    low = su * sine - cu * cosine * ca
    north = np.arctan2(su * cosine + cu * sine * ca, (1.0 - _F) * np.hypot(at_equator, low))
    turn = np.arctan2(sine * sa, cu * cosine - su * sine * ca)
    east = turn - _longitude(at_equator, square, sigma, sine, cosine, middle)
    return np.degrees(north), longitude + np.degrees(east), np.degrees(np.arctan2(at_equator, -low))


def _reduced(latitude: ArrayLike) -> Array:
    """Compute reduced latitudes, radians."""
    latitude = np.radians(np.asarray(latitude, float))
    return np.arctan2((1.0 - _F) * np.sin(latitude), np.cos(latitude))


def _series(square: Array) -> tuple[Array, Array]:
    """Compute A and B of eqs. 3 and 4 from the squared cosine of the azimuth at the equator."""
    u = square * (A * A - _B * _B) / (_B * _B)
    return (
        1.0 + u / 16384.0 * (4096.0 + u * (-768.0 + u * (320.0 - 175.0 * u))),
        u / 1024.0 * (256.0 + u * (-128.0 + u * (74.0 - 47.0 * u))),
    )


def _arc(square: Array, sine: Array, cosine: Array, middle: Array) -> Array:
    """Compute the correction of an arc, radians (eq. 6)."""
    b = _series(square)[1]
    inner = cosine * (-1.0 + 2.0 * middle**2)
    outer = b / 6.0 * middle * (-3.0 + 4.0 * sine**2) * (-3.0 + 4.0 * middle**2)
    return b * sine * (middle + b / 4.0 * (inner - outer))


def _longitude(
    at_equator: Array, square: Array, sigma: Array, sine: Array, cosine: Array, middle: Array
) -> Array:
    """Compute the longitude difference, sphere minus ellipsoid, radians (eqs. 10 and 11)."""
    c = _F / 16.0 * square * (4.0 + _F * (4.0 - 3.0 * square))
    series = sigma + c * sine * (middle + c * cosine * (-1.0 + 2.0 * middle**2))
    return (1.0 - c) * _F * at_equator * series
