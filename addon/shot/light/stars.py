"""Stars: the brightest ones at their true places, fainter ones at random, in a chart of the whole sky.

The brightest stars have positions (J2000), V magnitudes and B - V colours of the Bright Star Catalogue (D.
Hoffleit and W. H. Warren 1991, fifth edition). Fainter stars are synthetic: their number grows with magnitude
and towards the Milky Way as in the sky, their places are random. Precession since J2000 (0.3 degrees by 2026)
is neglected.

The chart is in galactic coordinates, since the Milky Way is then its middle row, and few stars are near its
poles. A texel has at most one star.
"""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

ROWS, COLUMNS = 128, 256
MARGIN = 0.2
"""Least distance of a star from the edges of its texel, as a share of it: 0.28 degrees."""
DARK_SKY = 21.6
"""V magnitude of a square arcsecond of dark sky at the zenith (K. Krisciunas 1997, PASP 109, 1181)."""
_COMPLETE, _FAINTEST = 2.3, 6.5  # magnitudes, to which the table is complete, and to which stars are drawn
_COUNT, _SLOPE = 8400, 0.503  # stars brighter than 6.5, and growth of log10 of their number per magnitude
_DISC, _DISC_SHARE = 12.0, 0.45  # degrees, galactic latitude that holds a share of the stars (by eye)
_GALACTIC = np.array(
    [
        [-0.0548755604, -0.8734370902, -0.4838350155],
        [0.4941094279, -0.4448296300, 0.7469822445],
        [-0.8676661490, -0.1980763734, 0.4559837762],
    ]
)  # from equatorial J2000 to galactic axes (Hipparcos catalogue, ESA SP-1200, 1997, vol. 1, 1.5.3)

# Name, right ascension (h min), declination (degrees and arcminutes), V, B - V
_BRIGHTEST = """
Sirius 6 45.1 -16 43 -1.46 0.00|Canopus 6 24.0 -52 42 -0.72 0.15|RigilKentaurus 14 39.6 -60 50 -0.27 0.71
Arcturus 14 15.7 +19 11 -0.04 1.23|Vega 18 36.9 +38 47 0.03 0.00|Capella 5 16.7 +46 00 0.08 0.80
Rigel 5 14.5 -08 12 0.12 -0.03|Procyon 7 39.3 +05 14 0.38 0.42|Achernar 1 37.7 -57 14 0.46 -0.16
Betelgeuse 5 55.2 +07 24 0.50 1.85|Hadar 14 03.8 -60 22 0.61 -0.23|Altair 19 50.8 +08 52 0.77 0.22
Acrux 12 26.6 -63 06 0.77 -0.24|Aldebaran 4 35.9 +16 31 0.85 1.54|Antares 16 29.4 -26 26 0.96 1.83
Spica 13 25.2 -11 10 0.98 -0.23|Pollux 7 45.3 +28 02 1.14 1.00|Fomalhaut 22 57.7 -29 37 1.16 0.09
Mimosa 12 47.7 -59 41 1.25 -0.23|Deneb 20 41.4 +45 17 1.25 0.09|Regulus 10 08.4 +11 58 1.35 -0.11
Adhara 6 58.6 -28 58 1.50 -0.21|Castor 7 34.6 +31 53 1.58 0.03|Shaula 17 33.6 -37 06 1.63 -0.22
Gacrux 12 31.2 -57 07 1.63 1.59|Bellatrix 5 25.1 +06 21 1.64 -0.22|Elnath 5 26.3 +28 36 1.65 -0.13
Miaplacidus 9 13.2 -69 43 1.68 0.00|Alnilam 5 36.2 -01 12 1.70 -0.19|Alnair 22 08.2 -46 58 1.74 -0.13
Alnitak 5 40.8 -01 57 1.77 -0.21|Alioth 12 54.0 +55 58 1.77 -0.02|Mirfak 3 24.3 +49 52 1.79 0.48
Dubhe 11 03.7 +61 45 1.79 1.07|Wezen 7 08.4 -26 24 1.84 0.68|KausAustralis 18 24.2 -34 23 1.85 -0.03
Avior 8 22.5 -59 31 1.86 1.28|Alkaid 13 47.5 +49 19 1.86 -0.19|Menkalinan 5 59.5 +44 57 1.90 0.03
Atria 16 48.7 -69 02 1.92 1.44|Alhena 6 37.7 +16 24 1.93 0.00|Peacock 20 25.6 -56 44 1.94 -0.20
Mirzam 6 22.7 -17 57 1.98 -0.23|Alphard 9 27.6 -08 40 1.98 1.44|Hamal 2 07.2 +23 28 2.00 1.15
Polaris 2 31.8 +89 16 2.02 0.60|Nunki 18 55.3 -26 18 2.02 -0.22|Diphda 0 43.6 -17 59 2.04 1.02
Alpheratz 0 08.4 +29 05 2.06 -0.11|Mirach 1 09.7 +35 37 2.06 1.58|Saiph 5 47.8 -09 40 2.06 -0.17
Menkent 14 06.7 -36 22 2.06 1.01|Rasalhague 17 34.9 +12 34 2.08 0.15|Kochab 14 50.7 +74 09 2.08 1.47
Algol 3 08.2 +40 57 2.12 -0.05|Denebola 11 49.1 +14 34 2.14 0.09|Sadr 20 22.2 +40 15 2.20 0.68
Suhail 9 08.0 -43 26 2.21 1.66|Alphecca 15 34.7 +26 43 2.23 -0.02|Schedar 0 40.5 +56 32 2.23 1.17
Mintaka 5 32.0 -00 18 2.23 -0.22|Eltanin 17 56.6 +51 29 2.23 1.52|Naos 8 03.6 -40 00 2.25 -0.26
Mizar 13 23.9 +54 56 2.27 0.02|Almach 2 03.9 +42 20 2.10 1.37|Caph 0 09.2 +59 09 2.27 0.34
Merak 11 01.8 +56 23 2.37 -0.02|Phecda 11 53.8 +53 42 2.44 0.00|Scheat 23 03.8 +28 05 2.42 1.67
Enif 21 44.2 +09 53 2.39 1.53|Ankaa 0 26.3 -42 18 2.39 1.09|Alderamin 21 18.6 +62 35 2.44 0.22
Markab 23 04.8 +15 12 2.49 -0.04|Izar 14 45.0 +27 04 2.37 0.97|Albireo 19 30.7 +27 58 3.08 1.13
Megrez 12 15.4 +57 02 3.31 0.08|Sheliak 18 50.1 +33 22 3.45 0.00|Sulafat 18 58.9 +32 41 3.24 -0.05
Tarazed 19 46.3 +10 37 2.72 1.52|Alshain 19 55.3 +06 24 3.71 0.86|Arneb 5 32.7 -17 49 2.58 0.21
Gienah 12 15.8 -17 33 2.59 -0.11|Algieba 10 20.0 +19 51 1.98 1.15|Thuban 14 04.4 +64 22 3.65 -0.05
Alcyone 3 47.5 +24 06 2.87 -0.09|Atlas 3 49.2 +24 03 3.63 -0.09|Electra 3 44.9 +24 07 3.70 -0.11
"""

Array = NDArray[np.float64]


def brightest() -> tuple[list[str], Array]:
    """Return names (n,) of the brightest stars, and rows (n, 4).

    The columns are right ascension and declination (degrees, J2000), V magnitude and B - V.
    """
    names, rows = [], []
    for entry in _BRIGHTEST.replace("\n", "|").split("|"):
        if entry:
            name, hours, minutes, degrees, arcminutes, magnitude, colour = entry.split()
            sign = -1.0 if degrees.startswith("-") else 1.0
            ascension = 15.0 * (float(hours) + float(minutes) / 60.0)
            declination = sign * (abs(float(degrees)) + float(arcminutes) / 60.0)
            names.append(name)
            rows.append((ascension, declination, float(magnitude), float(colour)))
    return names, np.array(rows)


def sidereal_angle(moment: datetime, longitude: float) -> float:
    """Return the local mean sidereal time (radians, not wrapped) at a longitude (degrees).

    J. Meeus (1998, "Astronomical Algorithms", second edition), 12.4, without its smallest terms.
    """
    days = (moment - datetime(2000, 1, 1, 12, tzinfo=UTC)).total_seconds() / 86_400.0
    return float(np.radians(280.46061837 + 360.98564736629 * days + longitude))


def galactic_axes(latitude: float) -> Array:
    """Return the axes (3, 3) of galactic coordinates as rows (east, north, up) at sidereal time 0."""
    sine, cosine = np.sin(np.radians(latitude)), np.cos(np.radians(latitude))
    equatorial = np.array([[0.0, -sine, cosine], [1.0, 0.0, 0.0], [0.0, cosine, sine]])
    return _GALACTIC @ equatorial


def pole(latitude: float) -> Array:
    """Return the unit vector (east, north, up) towards the celestial north pole."""
    return np.array([0.0, np.cos(np.radians(latitude)), np.sin(np.radians(latitude))])


def chart(seed: int) -> NDArray[np.float32]:
    """Return the chart (ROWS, COLUMNS, 4) from galactic latitude -90 and longitude 0.

    Channels are the star's place within its texel (across, up; 0..1), its flux, 1 for magnitude 0, and its
    B - V from -0.4 (0) to 2.0 (1).
    """
    _, catalogue = brightest()
    longitude, latitude = _galactic(np.radians(catalogue[:, 0]), np.radians(catalogue[:, 1]))
    random = np.random.default_rng([seed, 41])
    low = 10.0 ** (_SLOPE * (_COMPLETE - _FAINTEST))
    magnitude = _FAINTEST + np.log10(random.uniform(low, 1.0, _COUNT)) / _SLOPE
    even = np.arcsin(random.uniform(-1.0, 1.0, _COUNT))
    disc = np.radians(np.clip(random.laplace(0.0, _DISC, _COUNT), -80.0, 80.0))
    latitude = np.append(np.where(random.uniform(size=_COUNT) < _DISC_SHARE, disc, even), latitude)
    longitude = np.append(random.uniform(0.0, 2.0 * np.pi, _COUNT), longitude)
    magnitude = np.append(magnitude, catalogue[:, 2])
    colour = np.append(np.clip(random.normal(0.55, 0.5, _COUNT), -0.3, 1.8), catalogue[:, 3])
    across, up = longitude / (2.0 * np.pi) * COLUMNS, (latitude / np.pi + 0.5) * ROWS
    column, row = np.minimum(across.astype(int), COLUMNS - 1), np.minimum(up.astype(int), ROWS - 1)
    order = np.argsort(-magnitude, kind="stable")  # a texel keeps its brightest star, written last
    values = np.stack(
        [
            np.clip(across - column, MARGIN, 1.0 - MARGIN),
            np.clip(up - row, MARGIN, 1.0 - MARGIN),
            10.0 ** (-0.4 * magnitude),
            (colour + 0.4) / 2.4,
        ],
        axis=-1,
    )
    made = np.zeros((ROWS, COLUMNS, 4), np.float32)
    for index in order:
        made[row[index], column[index]] = values[index]
    return made


def _galactic(ascension: Array, declination: Array) -> tuple[Array, Array]:
    """Return galactic longitude (0 to 2 pi) and latitude of equatorial coordinates, radians."""
    flat = np.cos(declination)
    way = np.stack([flat * np.cos(ascension), flat * np.sin(ascension), np.sin(declination)])
    x, y, z = _GALACTIC @ way
    return np.arctan2(y, x) % (2.0 * np.pi), np.arcsin(np.clip(z, -1.0, 1.0))
