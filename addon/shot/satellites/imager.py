"""Simulated satellite imager: brightness temperature, fire radiative power and fire mask, with subpixel fire.

A pixel's radiance is (1 - f) L(background) + f L(1000 K) (J. Dozier 1981, Remote Sensing of Environment 11,
221), at one wavelength for each band. Fires radiate 14 % of their heat (M. J. Wooster et al. 2005, doi
10.1029/2005JD006318: 14 +- 3 %). So f is the area fraction that emits this part of the run's heat flux at
1000 K. The background is the run's air, and ground that cools after the fire. Atmosphere, smoke, clouds and
reflected sunlight (some kelvin at 3.9 um by day) are left out. Pixels are adjacent boxes of uniform response.

The saturation temperatures of ABI, 400 K in band 7 and 330 K in band 14, are from C. C. Schmidt et al.
2020, "GOES-R ABI Algorithm Theoretical Basis Document for Fire / Hot Spot Characterization" 2.7, table 2.3.
Users of VIIRS's fire product take I4 as saturated from 367 K. No document of the instrument's makers was
available for that value, nor for the 380 K of I5.

Fire radiative power by mid-wave infrared radiance is A sigma / a (L - L(background)) (Wooster et al. 2003,
2005), with a = 3.0e-9 W m-2 sr-1 um-1 K-4 at 3.9 um. At 1000 K that is 1.13 of the true power, so all pixels
together have 0.158 of the run's heat as long as none is saturated.

VIIRS's I4 saturates in most fires, so its product of 375 m (VNP14IMG) takes the power from band M13, of 750 m
(W. Schroeder, P. Oliva, L. Giglio and I. A. Csiszar 2014, Remote Sensing of Environment 143, 85; "VIIRS 375 m
Active Fire Detection and Characterization Algorithm Theoretical Basis Document" 1.0, 2016). M13 is at 4.05
um, its low gain measures up to 634 K, and a = 2.88e-9 there: 1.12 of the power at 1000 K, 0.157 of the heat.
A pixel of M13 is 2 x 2 of 375 m. Its power is shared evenly among the pixels that show
fire, and is zero without such a pixel.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from firetwin_core import constants, sensor
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...run import burning
from ..fire import air_temperature
from ..fire.fire import Fire
from .grid import Array, EvenGrid, FixedGrid, ImagerGrid, pixel_areas

FIRE = 1000.0  # K
RADIATED = 0.14  # radiative fraction of the heat
NONE, BURNING, SATURATED = 0, 10, 11  # values of the fire mask, as in GOES-R's fire product
_WARMER = 10.0  # K, excess of the short band over the long band that marks fire (assumed)
_PARTS = 6  # samples of the background along a pixel's side


@dataclass(frozen=True)
class PowerBand:
    """Band of fire radiative power.

    Attributes
    ----------
    name, wave, saturation
        Name, wavelength (um) and saturation temperature (K).
    a
        Radiance of a fire over the fourth power of its temperature, W m-2 sr-1 um-1 K-4.
    side
        Pixels of the imager's other bands along a side of this band's pixel.
    """

    name: str
    wave: float
    saturation: float
    a: float
    side: int = 1


@dataclass(frozen=True)
class Instrument:
    """Imager: wavelengths (um) and saturation temperatures (K) of its bands, and the band of power."""

    name: str
    title: str
    short: float
    long: float
    saturation: tuple[float, float]
    power: PowerBand
    since: int  # year of its first picture
    hypothetical: str

    def label(self, year: int) -> str:
        """Label that a picture of a fire of this year must carry."""
        return f"hypothetical for {year}" if year < self.since else "hypothetical pass"


ABI = Instrument(
    "abi",
    "GOES-R Advanced Baseline Imager, bands 7 and 14",
    3.9,
    11.2,
    (400.0, 330.0),
    PowerBand("band 7", 3.9, 400.0, 3.0e-9),
    2017,
    "hypothetical: this imager is on GOES-16 to -19, launched from 2016 on",
)
VIIRS = Instrument(
    "viirs",
    "VIIRS-like imager at 375 m, bands I4 and I5, gridded",
    3.74,
    11.45,
    (367.0, 380.0),
    PowerBand("band M13", 4.05, 634.0, 2.88e-9, 2),
    2012,
    "hypothetical: seen from straight above at this moment; real passes are about 01:30 and 13:30",
)
INSTRUMENTS = {each.name: each for each in (ABI, VIIRS)}


class NothingSeenError(ValueError):
    """No whole pixel lies in the run's domain."""


class HorizonError(NothingSeenError):
    """The run is below the horizon of the satellite."""


@dataclass(frozen=True)
class ImagerPicture:
    """Simulated measurement of an imager, (rows, columns) each.

    Attributes
    ----------
    short, long
        Brightness temperatures, K.
    power
        Fire radiative power, W.
    mask
        Fire mask from the mid-wave infrared band: `NONE`, `BURNING` or `SATURATED`.
    limited
        Number of saturated pixels in the band of power; their `power` is a lower bound.
    area
        Ground area of each pixel, m2.
    grid, row, column
        Pixel grid, and the first row and column.
    heat
        The run's heat release rate in all pixels, W.
    """

    short: Array
    long: Array
    power: Array
    mask: NDArray[np.uint8]
    area: Array
    grid: ImagerGrid
    row: int
    column: int
    heat: float
    limited: int


def grid_of(instrument: Instrument, run: Run, longitude: float) -> ImagerGrid:
    """Pixel grid of an instrument; a geostationary one is above a longitude (degrees)."""
    return FixedGrid(longitude) if instrument is ABI else EvenGrid(float(np.mean(run.latitude)), 375.0)


def picture(instrument: Instrument, grid: ImagerGrid, fire: Fire, time: float) -> ImagerPicture:
    """Simulate a picture of a run's fire at a time (s), of the pixels entirely within the run's domain."""
    run = fire.run
    rows, columns = pixels_inside(grid, run)
    area = pixel_areas(grid, rows, columns)
    kelvin = _background(grid, fire, time, rows, columns)
    part, heat = _burning(grid, fire, time, rows, columns, area)
    shown = []
    for wave, most in zip((instrument.short, instrument.long), instrument.saturation, strict=True):
        background = sensor.spectral_radiance(kelvin, wave).mean(axis=-1)
        radiance = (1.0 - part) * background + part * sensor.spectral_radiance(FIRE, wave)
        radiance = np.minimum(radiance, sensor.spectral_radiance(most, wave))
        shown.append(sensor.spectral_temperature(radiance, wave))
    mask = np.where(shown[0] - shown[1] > _WARMER, BURNING, NONE)
    mask = np.where(shown[0] >= instrument.saturation[0] - 1e-6, SATURATED, mask).astype(np.uint8)
    blocks = index_blocks(instrument.power.side, rows, columns)
    power, limited = measure_power(instrument.power, kelvin, part, area, mask > NONE, blocks)
    return ImagerPicture(
        shown[0], shown[1], power, mask, area, grid, int(rows[0]), int(columns[0]), heat, limited
    )


def index_blocks(side: int, rows: NDArray, columns: NDArray) -> NDArray[np.int64]:
    """Index (rows, columns) of the larger pixel, `side` by `side`, around each pixel."""
    down, across = rows // side - rows[0] // side, columns // side - columns[0] // side
    return down[:, None] * (across[-1] + 1) + across


def measure_power(
    band: PowerBand,
    kelvin: Array,
    part: Array,
    area: Array,
    fire: NDArray[np.bool_],
    blocks: NDArray[np.int64],
) -> tuple[Array, int]:
    """Fire radiative power (W) of each pixel, and number of saturated pixels in the band."""

    def total(values: NDArray) -> Array:
        return np.bincount(blocks.ravel(), values.ravel()).astype(np.float64, copy=False)

    background = sensor.spectral_radiance(kelvin, band.wave).mean(axis=-1)
    radiance = (1.0 - part) * background + part * sensor.spectral_radiance(FIRE, band.wave)
    whole, most = total(area), float(sensor.spectral_radiance(band.saturation, band.wave))
    seen = total(area * radiance) / whole
    above = np.minimum(seen, most) - total(area * background) / whole
    power = whole * constants.STEFAN_BOLTZMANN / band.a * np.maximum(above, 0.0)
    shared = power / np.maximum(total(fire.astype(np.float64)), 1.0)
    return np.where(fire, shared[blocks], 0.0), int((seen > most).sum())


def pixels_inside(grid: ImagerGrid, run: Run) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of whole pixels within the run's domain.

    Raises
    ------
    NothingSeenError
        The domain is smaller than a pixel; HorizonError: it is below the horizon.
    """
    latitude = np.linspace(run.latitude.min(), run.latitude.max(), 33)
    longitude = np.linspace(run.longitude.min(), run.longitude.max(), 33)
    sides = [grid.forward(latitude, np.full(33, each)) for each in longitude[[0, -1]]]
    ends = [grid.forward(np.full(33, each), longitude) for each in latitude[[0, -1]]]
    west, east = (column for _, column in sides)
    south, north = (row for row, _ in ends)
    if not np.all(np.isfinite([west, east, south, north])):
        raise HorizonError("the run is behind the horizon of this satellite")
    rows = np.arange(int(np.ceil(north.max())), int(np.floor(south.min())))
    columns = np.arange(int(np.ceil(west.max())), int(np.floor(east.min())))
    if len(rows) == 0 or len(columns) == 0:
        raise NothingSeenError("the domain of the run contains no complete pixel of this imager")
    return rows, columns


def _background(grid: ImagerGrid, fire: Fire, time: float, rows: NDArray, columns: NDArray) -> Array:
    """Background temperature (rows, columns, parts), K, of ground without flames at points of each pixel."""
    run = fire.run
    inside = (np.arange(_PARTS) + 0.5) / _PARTS
    row = (rows[:, None] + inside).reshape(len(rows), 1, _PARTS, 1)
    column = (columns[:, None] + inside).reshape(1, len(columns), 1, _PARTS)
    latitude, longitude = grid.reverse(*np.broadcast_arrays(row, column))
    kelvin = bilinear(air_temperature.at(run, time), *air_temperature.indices(run, latitude, longitude))
    fuel_row, fuel_column = (
        np.rint(air_temperature.index(axis, place)).astype(np.int64)
        for axis, place in ((run.fuel_latitude, latitude), (run.fuel_longitude, longitude))
    )
    age = time - fire.arrival[fuel_row, fuel_column]
    kelvin = kelvin + air_temperature.cooling(
        np.where(age > 0.0, age, 0.0), fire.residence[fuel_row, fuel_column]
    )
    return kelvin.reshape(len(rows), len(columns), -1)


def _burning(
    grid: ImagerGrid, fire: Fire, time: float, rows: NDArray, columns: NDArray, area: Array
) -> tuple[Array, float]:
    """Fire area fraction of each pixel, and total heat release rate (W)."""
    sources = fire.sources(time)
    if len(sources.power) == 0:
        return np.zeros(area.shape), 0.0
    latitude, longitude, _ = fire.frame.reverse(sources.position)
    row, column = (np.floor(v).astype(np.int64) for v in grid.forward(latitude, longitude))
    row, column = row - rows[0], column - columns[0]
    inside = (row >= 0) & (row < len(rows)) & (column >= 0) & (column < len(columns))
    flat = row[inside] * len(columns) + column[inside]
    heat = np.bincount(flat, sources.power[inside], area.size).reshape(area.shape)
    flames = RADIATED * heat / (constants.STEFAN_BOLTZMANN * FIRE**4)
    return np.minimum(flames / area, 1.0), float(heat.sum())


def times(run: Run, every: float) -> list[float]:
    """Model times (s) of a run at an interval (s), from its first time."""
    return [float(time) for time in np.arange(run.times[0], run.times[-1] + 1e-6, every)]


def film(
    instrument: Instrument, run: Run, longitude: float, moments: list[float]
) -> Iterator[tuple[float, ImagerPicture]]:
    """Pictures at these model times (s), each with its time."""
    grid, fire = grid_of(instrument, run, longitude), Fire(run, moments[0], moments[-1], burning.BURN_TIME)
    for time in moments:
        yield time, picture(instrument, grid, fire, time)
