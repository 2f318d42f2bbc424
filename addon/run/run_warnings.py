"""Warnings about a run: values that are missing, and sizes that are assumed. Needs no Blender."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from . import areas, bounds, burning, times

_CLIFF = 1_500.0  # m; the highest cliff, of Mount Thor, has 1,250 m
_STEEPEST = 2.0  # rise over run of mountain sides of a cell or more (assumed)
_GAPS = "heat_flux has no value"


def texts(run: Run) -> list[str]:
    """List all warnings about a run; `released.warnings` has the ones about its energy."""
    bounds.check_flux(run)
    return [*_of_values(run), *_single_cell(run), *_cliffs(run)]


def of_fire(run: Run) -> list[str]:
    """List the warnings that concern a run's fire: gaps of heat flux, an assumed cell size, and cliffs."""
    bounds.check_flux(run)
    gaps = [text for text in _of_values(run) if text.startswith("heat_flux")]
    return [*gaps, *_single_cell(run), *_cliffs(run)]


def _of_values(run: Run) -> list[str]:
    return [text + _first_gap(run, text) for text in run.warnings]


def _first_gap(run: Run, text: str) -> str:
    """Return the first time and place without heat flux, as an addition to the warning about gaps."""
    if not text.startswith(_GAPS):
        return ""
    for index, time in enumerate(run.times):
        gaps = np.argwhere(~np.isfinite(run.heat_flux(index)))
        if len(gaps):
            row, column = gaps[0]
            place = f"{run.latitude[row]:.4f} N {run.longitude[column]:.4f} E"
            moment = times.iso(times.utc(run, float(time)))
            return f", first at {moment}, {place}; there it counts as no fire"
    return ""


def _single_cell(run: Run) -> list[str]:
    if run.elevation.size > 1:
        return []
    side = np.sqrt(burning.model_cell_area(run))
    return [
        f"the run has a single cell of unknown size; {side:,.0f} m is assumed, give it 2 x 2 cells or more"
    ]


def _cliffs(run: Run) -> list[str]:
    """Warn of the highest step between neighbouring cells if no cliff of the Earth has it."""
    height = np.asarray(run.elevation, np.float64)
    steps = [np.abs(np.nan_to_num(np.diff(height, axis=axis))) for axis in (0, 1)]
    sizes = areas.cell_size(run.latitude, run.longitude)[::-1]
    places = [
        (step.max(), *np.unravel_index(step.argmax(), step.shape))
        for step, size in zip(steps, sizes, strict=True)
        if step.size and step.max() > max(_CLIFF, _STEEPEST * size)
    ]
    if not places:
        return []
    step, row, column = max(places)
    place = f"{run.latitude[row]:.4f} N {run.longitude[column]:.4f} E"
    return [
        f"elevation has a step of {step:,.0f} m between two cells at {place}; check its values and its unit"
    ]
