"""Universal Transverse Mercator on WGS84, and names of US National Grid squares.

The series of Krueger (1912) in the third flattening n to n^6, as in Karney 2011, J. Geod. 85, 475-485
(eqs. 7 to 12, 35 and 36): errors below 1 um within 3000 km of the central meridian. Letters of the grid:
NGA.STND.0037_2.0.0_GRIDS; the US National Grid (FGDC-STD-011-2001) has the same letters on WGS84.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .ellipsoid import E2, A

Array = NDArray[np.float64]

_SCALE, _FALSE_EAST, _FALSE_NORTH = 0.9996, 500_000.0, 10_000_000.0
_E = math.sqrt(E2)
_N = (1.0 - math.sqrt(1.0 - E2)) / (1.0 + math.sqrt(1.0 - E2))
_RADIUS = A / (1.0 + _N) * (1.0 + _N**2 / 4.0 + _N**4 / 64.0 + _N**6 / 256.0)


def _series(rows: tuple[tuple[float, ...], ...]) -> Array:
    """Evaluate coefficients 1 to 6 from rows of factors of n^j to n^6."""
    return np.array([sum(c * _N ** (j + i) for i, c in enumerate(row)) for j, row in enumerate(rows, 1)])


_ALPHA = _series(
    (
        (1 / 2, -2 / 3, 5 / 16, 41 / 180, -127 / 288, 7891 / 37800),
        (13 / 48, -3 / 5, 557 / 1440, 281 / 630, -1983433 / 1935360),
        (61 / 240, -103 / 140, 15061 / 26880, 167603 / 181440),
        (49561 / 161280, -179 / 168, 6601661 / 7257600),
        (34729 / 80640, -3418889 / 1995840),
        (212378941 / 319334400,),
    )
)
_BETA = _series(
    (
        (1 / 2, -2 / 3, 37 / 96, -1 / 360, -81 / 512, 96199 / 604800),
        (1 / 48, 1 / 15, -437 / 1440, 46 / 105, -1118711 / 3870720),
        (17 / 480, -37 / 840, -209 / 4480, 5569 / 90720),
        (4397 / 161280, -11 / 504, -830251 / 7257600),
        (4583 / 161280, -108847 / 3991680),
        (20648693 / 638668800,),
    )
)

_BANDS = "CDEFGHJKLMNPQRSTUVWXX"
_COLUMNS = ("ABCDEFGH", "JKLMNPQR", "STUVWXYZ")
_ROWS = "ABCDEFGHJKLMNPQRSTUV"
_SQUARE = 100_000.0  # m


@dataclass(frozen=True)
class Zone:
    """A UTM zone.

    Attributes
    ----------
    number
        1 to 60.
    south
        True for southings with a false northing of 10,000 km.
    """

    number: int
    south: bool

    @classmethod
    def at(cls, latitude: float, longitude: float) -> Zone:
        """Choose the zone of a place (degrees), with the exceptions for Norway and Svalbard."""
        east = (longitude + 180.0) % 360.0 - 180.0
        number = int((east + 180.0) // 6.0) % 60 + 1
        if 56.0 <= latitude < 64.0 and 3.0 <= east < 12.0:
            number = 32
        elif 72.0 <= latitude < 84.0 and 0.0 <= east < 42.0:
            number = 31 + 2 * int((east + 3.0) // 12.0)
        return cls(number, latitude < 0.0)

    @property
    def meridian(self) -> float:
        """Longitude of the central meridian, degrees."""
        return 6.0 * self.number - 183.0

    @property
    def epsg(self) -> int:
        """EPSG code of the zone on WGS84."""
        return (32700 if self.south else 32600) + self.number

    @property
    def name(self) -> str:
        """Zone and hemisphere: ``10N``."""
        return f"{self.number}{'S' if self.south else 'N'}"

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Project degrees to east and north, m."""
        phi = np.radians(np.asarray(latitude, np.float64))
        away = (np.asarray(longitude, np.float64) - self.meridian + 180.0) % 360.0 - 180.0
        turn = np.radians(away)
        tau = np.tan(phi)
        conformal = _conformal(tau)
        xi = np.arctan2(conformal, np.cos(turn))
        eta = np.arcsinh(np.sin(turn) / np.hypot(conformal, np.cos(turn)))
        w = xi + 1j * eta
        for j, factor in enumerate(_ALPHA, 1):
            w = w + factor * np.sin(2 * j * (xi + 1j * eta))
        east = _FALSE_EAST + _SCALE * _RADIUS * w.imag
        north = _SCALE * _RADIUS * w.real + (_FALSE_NORTH if self.south else 0.0)
        return east, north

    def inverse(self, east: ArrayLike, north: ArrayLike) -> tuple[Array, Array]:
        """Convert east and north (m) to latitude and longitude, degrees; longitudes near the meridian's."""
        down = np.asarray(north, np.float64) - (_FALSE_NORTH if self.south else 0.0)
        w = (down + 1j * (np.asarray(east, np.float64) - _FALSE_EAST)) / (_SCALE * _RADIUS)
        z = w
        for j, factor in enumerate(_BETA, 1):
            z = z - factor * np.sin(2 * j * w)
        xi, eta = z.real, z.imag
        conformal = np.sin(xi) / np.hypot(np.sinh(eta), np.cos(xi))
        turn = np.arctan2(np.sinh(eta), np.cos(xi))
        tau = conformal
        for _ in range(4):  # Newton's method, Karney eqs. 19 to 21
            found = _conformal(tau)
            slope = np.sqrt((1.0 + found**2) * (1.0 + tau**2)) * (1.0 - E2) / (1.0 + (1.0 - E2) * tau**2)
            tau = tau + (conformal - found) / slope
        return np.degrees(np.arctan(tau)), self.meridian + np.degrees(turn)

    def convergence(self, latitude: float, longitude: float) -> float:
        """Compute the angle from true north to grid north at a place, degrees clockwise."""
        step = 1e-4
        (e0, e1), (n0, n1) = self.forward([latitude - step, latitude + step], [longitude] * 2)
        return -math.degrees(math.atan2(e1 - e0, n1 - n0))

    def square(self, latitude: float, east: float, north: float) -> str:
        """Name the grid zone and 100 km square of a point: ``10S FJ``.

        Parameters
        ----------
        latitude
            Latitude of the point, degrees, which gives the letter of the band.
        east, north
            UTM coordinates, m.
        """
        band = _BANDS[min(max(int((latitude + 80.0) // 8.0), 0), 20)]
        column = _COLUMNS[(self.number - 1) % 3][int(east // _SQUARE) - 1]
        row = _ROWS[(int(north // _SQUARE) + (5 if self.number % 2 == 0 else 0)) % 20]
        return f"{self.number}{band} {column}{row}"


def _conformal(tau: Array) -> Array:
    """Compute the tangent of the conformal latitude from the tangent of the latitude (Karney eqs. 7 to 9)."""
    sine = tau / np.hypot(1.0, tau)
    sigma = np.sinh(_E * np.arctanh(_E * sine))
    return tau * np.hypot(1.0, sigma) - sigma * np.hypot(1.0, tau)


def usng(latitude: float, longitude: float, digits: int = 4) -> str:
    """Format a place as a US National Grid position: ``10S FJ 8512 9345`` (`digits` = 4: 10 m)."""
    zone = Zone.at(latitude, longitude)
    east, north = (float(each) for each in zone.forward(latitude, longitude))
    step = 10 ** (5 - digits)
    parts = (f"{int(each % _SQUARE // step):0{digits}d}" for each in (east, north))
    return " ".join((zone.square(latitude, east, north), *parts))
