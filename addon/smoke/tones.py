"""Tone of smoke by phase and fuel: smoke of flames is sooty, smoke of smouldering fuel is pale at once.

The flow carries one age for all smoke. Here the dark share of smoke, which falls with age, is multiplied by
the share of its mass that flames made, because absorption mixes by mass. Smoke of flames is darker than smoke
of smouldering fuel (S. Liu et al. 2014, doi 10.1002/2013GL058392). It is painted with the age that has this
dark share. Its source is looked up where the wind has carried it from.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..run import fuel_category
from ..shot.fire import emissions
from ..shot.shot import Shot
from ..shot.terrain import noise

_FLAMING = 0.06, 0.5  # shares of flames in the heat of a place, from none to full soot (by eye)
_BLUR = 2  # passes of a 3 x 3 mean over the sources: plumes of neighbouring cells mix
_ALOFT = 1.3  # wind where smoke rises relative to 10 m (by eye)

Array = NDArray[np.float64]


def apparent_age(
    shot: Shot,
    time: float,
    age: NDArray[np.float32],
    corner: tuple[float, float],
    spacing: float,
    ages: tuple[float, float],
) -> NDArray[np.float32]:
    """Return the age (nz, rows, columns), s, that smoke is painted with at a model time (s).

    Parameters
    ----------
    age
        Age since emission (nz, rows, columns), s.
    corner, spacing
        West and south edge of the cells, and their size, m.
    ages
        Ages between which smoke turns from dark to white, s.
    """
    soot = soot_share(shot, time, corner, spacing, (age.shape[1], age.shape[2]))
    if soot.min() == 1.0:
        return age
    steps = np.minimum(age, ages[1]) * np.float32(_ALOFT / spacing)
    rows, columns = soot.shape
    row = np.arange(rows, dtype=np.float32)[None, :, None] - np.float32(shot.wind[1]) * steps
    column = np.arange(columns, dtype=np.float32)[None, None, :] - np.float32(shot.wind[0]) * steps
    row = np.clip(np.rint(row), 0, rows - 1).astype(np.int32)
    column = np.clip(np.rint(column), 0, columns - 1).astype(np.int32)
    dark = soot.astype(np.float32)[row, column] * (1.0 - noise.smoothstep(*ages, age))
    # The inverse of `smoothstep`
    way = 0.5 + np.sin(np.arcsin(np.clip(2.0 * dark - 1.0, -1.0, 1.0)) / 3.0)
    return np.maximum(age, ages[1] - (ages[1] - ages[0]) * way).astype(np.float32)


def soot_share(
    shot: Shot, time: float, corner: tuple[float, float], spacing: float, shape: tuple[int, int]
) -> Array:
    """Return how sooty the smoke of each cell (rows, columns) is, 1 at the flames of the darkest fuel."""
    sources = shot.fire.sources(time)
    soot = np.ones(shape)
    column, row = (np.floor((sources.position[:, k] - corner[k]) / spacing).astype(int) for k in (0, 1))
    inside = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1]) & (sources.power > 0.0)
    if not inside.any():
        return soot
    sources, cell = sources.take(inside), row[inside] * shape[1] + column[inside]
    flaming = noise.smoothstep(*_FLAMING, sources.flaming / sources.power)
    dark = _darkness(shot, sources.fuel_cell) / max(shot.fire.smoke.dark, 1.0e-3)
    emitted, sooty = (
        _blurred(np.bincount(cell, weight, soot.size).astype(np.float64).reshape(shape))
        for weight in (sources.smoke, sources.smoke * np.minimum(flaming * dark, 1.0))
    )
    smoky = emitted > 0.0
    soot[:] = sooty.sum() / max(emitted.sum(), 1.0e-12)  # the mean away from all sources
    soot[smoky] = sooty[smoky] / emitted[smoky]
    return soot


def _darkness(shot: Shot, fuel_cell: NDArray[np.int64]) -> Array:
    """Return the darkness of flames' smoke (n,) by the fuel of cells; a crown fire's for unknown cells."""
    run = shot.run
    row, column = np.divmod(np.maximum(fuel_cell, 0), len(run.fuel_longitude))
    first, last = int(row.min()), int(row.max()) + 1
    category = run.fuel_rows(fuel_category.FIELD, first, last) if run.has(fuel_category.FIELD) else None
    fields = [run.fuel_rows(name, first, last) for name in ("surface_fuel", "canopy_fuel")]
    index = row - first, column
    surface, canopy = (np.nan_to_num(field[index]) for field in fields)
    kind = emissions.kind(surface, canopy, None if category is None else category[index])
    dark = emissions.column("dark")
    return np.where(fuel_cell >= 0, dark[kind], dark[emissions.CROWN])


def _blurred(field: Array) -> Array:
    """Average over neighbours, `_BLUR` times; nothing comes from outside."""
    for _ in range(_BLUR):
        for axis in (0, 1):
            padded = np.pad(field, [(1, 1) if k == axis else (0, 0) for k in (0, 1)])
            count = field.shape[axis]
            field = np.mean([np.take(padded, np.arange(count) + shift, axis) for shift in range(3)], axis=0)
    return field
