"""Warnings about a run: values that are missing, and sizes that are assumed. Needs no Blender."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from . import burning, times

_GAPS = "heat_flux has no value"


def texts(run: Run) -> list[str]:
    """List all warnings about a run; `released.warnings` has the ones about its energy."""
    return [*_of_values(run), *_single_cell(run)]


def of_fire(run: Run) -> list[str]:
    """List the warnings that concern a run's fire: gaps of its heat flux, and an assumed cell size."""
    run.flux_range()  # reads all fluxes once
    return [*(text for text in _of_values(run) if text.startswith("heat_flux")), *_single_cell(run)]


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
