"""Air near the ground over the fire: warmed by it and drawn towards it. Scaling laws, not a flow model."""

import numpy as np
from firetwin_core.constants import GRAVITY
from numpy.typing import NDArray

from .grid import MODEL_CELL_SIZE, MODEL_CELLS

HEATED_DEPTH = 50.0  # m; WRF-SFIRE spreads ground heat over height as exp(-z / 50 m)
AIR_HEAT = 1100.0  # J/m3/K, density times specific heat of warm air at 1200 m
AIR_TEMPERATURE = 300.0  # K
INFLOW_REACH = 3000.0  # m
INFLOW_CORE = 500.0  # m


def warming(flux: NDArray, wind_speed: NDArray) -> NDArray[np.float64]:
    """Compute the temperature rise (K) of the lowest 50 m of air over a heat flux (W/m2), cell by cell.

    Balance of heating and flushing of a box of one cell by the wind and by convection, whose speed is
    Deardorff's (1970) w* = (g / T F / (rho cp) h)^(1/3).
    """
    kinematic = np.maximum(flux, 0) / AIR_HEAT
    convection = np.cbrt(GRAVITY / AIR_TEMPERATURE * kinematic * HEATED_DEPTH)
    return kinematic * (MODEL_CELL_SIZE / HEATED_DEPTH) / (np.maximum(wind_speed, 1.0) + convection)


class Inflow:
    """Wind drawn towards fire: each cell is a sink of air, felt within some 3 km.

    The volume drawn in per metre of height is the volume of the convection over the cell, w* times its width;
    its inward speed falls as 1 / (2 pi r) like any plane sink, softened within 500 m and damped beyond 3 km.
    """

    def __init__(self) -> None:
        size = 2 * MODEL_CELLS
        index = np.arange(size)
        offset = np.where(index < MODEL_CELLS, index, index - size) * MODEL_CELL_SIZE
        x, y = offset[None, :], offset[:, None]
        square = x**2 + y**2
        speed = np.exp(-square / (2 * INFLOW_REACH**2)) / (2 * np.pi * (square + INFLOW_CORE**2))
        self.size = size
        self.east = np.fft.rfft2(-x * speed)
        self.north = np.fft.rfft2(-y * speed)

    def wind(self, flux: NDArray) -> tuple[NDArray, NDArray]:
        """Eastward and northward wind (m/s) that the flux (ny, nx) in W/m2 adds."""
        convection = np.cbrt(GRAVITY / AIR_TEMPERATURE * np.maximum(flux, 0) / AIR_HEAT * HEATED_DEPTH)
        if not convection.any():
            return np.zeros(flux.shape), np.zeros(flux.shape)
        spectrum = np.fft.rfft2(convection * MODEL_CELL_SIZE, s=(self.size, self.size))
        cut = slice(0, MODEL_CELLS)
        rows = [np.fft.ifft(spectrum * each, axis=0)[cut] for each in (self.east, self.north)]
        east, north = (np.fft.irfft(each, self.size)[:, cut] for each in rows)
        return east, north
