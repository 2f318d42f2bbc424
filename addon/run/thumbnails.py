"""Thumbnails of a run's fuel and fire intensity, without axes and matplotlib, which Blender does not have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

FUEL = ("#f4efe1", "#dfe5b4", "#b4d184", "#7cb45c", "#438f45", "#1f6a36", "#0c4426")
INTENSITY = ("#fff7b0", "#ffe566", "#ffc81e", "#ff9a0a", "#f4560b", "#cf1710", "#8b0010")
"""Colours of the maps, from low to high values."""

SIDE = 192
"""Thumbnail width and height, pixels."""

FIRE = 1.0  # W/m2, as in the estimate of arrival times: model files hold fluxes of 1e-38
_BARE = (0.45, 0.43, 0.40)  # colour of unburned ground


def draw(run: Run) -> dict[str, NDArray[np.float32]]:
    """Draw maps of fuel and intensity, each (SIDE, SIDE, 4): sRGB and alpha from 0 to 1, south first."""
    fuel = np.nan_to_num(run.surface_fuel) + np.nan_to_num(run.canopy_fuel)
    share = fuel / max(float(fuel.max()), 1.0e-6)
    flux = strongest(run)
    high = max(float(flux.max()), 1.0e-6)
    heat = np.log(np.maximum(flux, 1.0e-9 * high) / high) / np.log(300.0) + 1.0
    burning = coloured(np.clip(heat, 0.0, 1.0), INTENSITY)
    burning[flux < FIRE] = _BARE
    return {
        "fuel": _square(coloured(share, FUEL), run.fuel_latitude, run.fuel_longitude),
        "intensity": _square(burning, run.latitude, run.longitude),
    }


def strongest(run: Run) -> NDArray[np.float32]:
    """Compute the maximum heat flux (W/m2) of each model cell over the run, (ny, nx); 0 without any."""
    flux = run.heat_flux(0).copy()
    for index in range(1, len(run.times)):
        np.fmax(flux, run.heat_flux(index), out=flux)
    return np.nan_to_num(flux)


def coloured(share: NDArray[np.floating], colours: Sequence[str]) -> NDArray[np.float32]:
    """Map values from 0 to 1, (h, w), to a colour ramp, (h, w, 3)."""
    table = np.array([[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in colours])
    at = np.linspace(0.0, 1.0, len(table))
    return np.stack([np.interp(share, at, table[:, i]) for i in range(3)], -1).astype(np.float32)


def _square(
    picture: NDArray[np.float32], latitude: NDArray[np.float64], longitude: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Orient a map north up and fit it into a square in true proportions, transparent outside."""
    if latitude[0] > latitude[-1]:
        picture = picture[::-1]
    if longitude[0] > longitude[-1]:
        picture = picture[:, ::-1]
    tall = max(float(np.ptp(latitude)), 1.0e-9)
    wide = max(float(np.ptp(longitude)) * float(np.cos(np.radians(np.mean(latitude)))), 1.0e-9)
    rows, columns = (max(round(SIDE * side / max(tall, wide)), 1) for side in (tall, wide))
    row, column = (
        ((np.arange(count) + 0.5) * size / count).astype(int)
        for count, size in zip((rows, columns), picture.shape, strict=False)
    )
    square = np.zeros((SIDE, SIDE, 4), np.float32)
    low, left = (SIDE - rows) // 2, (SIDE - columns) // 2
    square[low : low + rows, left : left + columns, :3] = picture[np.ix_(row, column)]
    square[low : low + rows, left : left + columns, 3] = 1.0
    return square
