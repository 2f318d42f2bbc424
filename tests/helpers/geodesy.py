"""Independent geodesy for the tests: WGS84 to local east-north-up, in NumPy and in 50 digits."""

import mpmath
import numpy as np
from numpy.typing import NDArray

A = 6378137.0
F = 1 / 298.257223563
E2 = F * (2 - F)


def geocentric(lat: NDArray, lon: NDArray, h: NDArray) -> NDArray:
    n = A / np.sqrt(1 - E2 * np.sin(lat) ** 2)
    return np.stack(
        [
            (n + h) * np.cos(lat) * np.cos(lon),
            (n + h) * np.cos(lat) * np.sin(lon),
            (n * (1 - E2) + h) * np.sin(lat),
        ],
        axis=-1,
    )


def enu(lat: NDArray, lon: NDArray, h: NDArray, origin: tuple[float, float, float]) -> NDArray:
    """Degrees and metres -> (..., 3) metres, by rotating geocentric differences (a few nm)."""
    lat, lon = np.radians(lat), np.radians(lon)
    lat0, lon0 = np.radians(origin[0]), np.radians(origin[1])
    d = geocentric(lat, lon, np.asarray(h, float)) - geocentric(lat0, lon0, np.float64(origin[2]))
    s, c, sl, cl = np.sin(lat0), np.cos(lat0), np.sin(lon0), np.cos(lon0)
    rotation = np.array([[-sl, cl, 0], [-s * cl, -s * sl, c], [c * cl, c * sl, s]])
    return d @ rotation.T


def enu_exact(lat: float, lon: float, h: float, origin: tuple[float, float, float]) -> list[mpmath.mpf]:
    """Local coordinates of one point, with 50 digits."""
    with mpmath.workdps(50):
        f = 1 / mpmath.mpf("298.257223563")
        e2 = f * (2 - f)

        def geocentric(lat: float, lon: float, h: float) -> mpmath.matrix:
            phi, lam = mpmath.radians(mpmath.mpf(lat)), mpmath.radians(mpmath.mpf(lon))
            n = mpmath.mpf(A) / mpmath.sqrt(1 - e2 * mpmath.sin(phi) ** 2)
            r = (n + h) * mpmath.cos(phi)
            z = (n * (1 - e2) + h) * mpmath.sin(phi)
            return mpmath.matrix([r * mpmath.cos(lam), r * mpmath.sin(lam), z])

        d = geocentric(lat, lon, h) - geocentric(*origin)
        phi, lam = mpmath.radians(mpmath.mpf(origin[0])), mpmath.radians(mpmath.mpf(origin[1]))
        s, c, sl, cl = mpmath.sin(phi), mpmath.cos(phi), mpmath.sin(lam), mpmath.cos(lam)
        return [
            -sl * d[0] + cl * d[1],
            -s * cl * d[0] - s * sl * d[1] + c * d[2],
            c * cl * d[0] + c * sl * d[1] + s * d[2],
        ]
