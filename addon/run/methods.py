"""Methods paragraph of a work with a run: model, grid, terrain, observations, software, and invented data."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import firetwin_core
import numpy as np
from firetwin_core.run import Run

from ..progress import count
from . import areas, citations, info, times
from .burned_fraction import FIELD

_AREAS = {
    "fuel_arrival_time": "arrival times of fuel cells",
    FIELD: "burned fractions of cells",
    "heat_flux": "heat fluxes",
}


@dataclass(frozen=True)
class Inputs:
    """Inputs of a work in addition to its run.

    Attributes
    ----------
    elevation
        Name of the elevation model; "": the run's own.
    observations
        Names of files to which the run was compared.
    sentences
        Sentences on further inputs.
    rendered
        Programs that rendered its pictures, with versions.
    exercise
        Stations, resources or lines are invented.
    """

    elevation: str = ""
    observations: Sequence[str] = ()
    sentences: Sequence[str] = ()
    rendered: Sequence[tuple[str, str]] = ()
    exercise: bool = False


def paragraph(run: Run, inputs: Inputs) -> str:
    """Describe the methods in sentences for a paper."""
    return " ".join(_sentences(run, inputs))


def _sentences(run: Run, inputs: Inputs) -> Iterator[str]:
    yield _model(run)
    yield _grid(run)
    if assumed := info.source(Path(run.path)).get("assumptions"):
        number = count(len(assumed), "assumption")
        yield f"Firetwin converted the files of the model with {number} (run.toml)."
    yield f"Burned areas are computed from {_AREAS[info.burned_from(run)]}."
    yield f"{_fields(inputs.elevation)} from the run."
    if inputs.observations:
        yield f"The run is compared with {', '.join(inputs.observations)}."
    else:
        yield "The run is not compared with observations."
    yield from inputs.sentences
    python = f"Python {platform.python_version()} and NumPy {np.__version__}"
    yield f"Firetwin {firetwin_core.__version__} with {python} computed areas, maps and tables."
    if inputs.rendered:
        programs = " and ".join(f"{name} {version}" for name, version in inputs.rendered)
        yield f"{programs} rendered the pictures."
        yield "Trees, flames, embers and fine smoke are modelled from fuels and heat; they are not observed."
    if inputs.exercise:
        yield "Stations, resources or lines are invented for an exercise."


def _model(run: Run) -> str:
    if run.synthetic:
        return f"The run {run.name} is synthetic: it is not the output of a fire-atmosphere model."
    if model := citations.model_name(run):
        return f"The fire model {model} computed the run {run.name}."
    return f"The fire model of the run {run.name} is not named."


def _grid(run: Run) -> str:
    first, last = (times.utc(run, float(run.times[index])) for index in (0, -1))
    cells, fuels = (
        _cells(*axes) for axes in ((run.latitude, run.longitude), (run.fuel_latitude, run.fuel_longitude))
    )
    return (
        f"It has {len(run.times):,} times from {first:%Y-%m-%d %H:%M} to {last:%Y-%m-%d %H:%M} UTC, "
        f"on {cells}; fuels are on {fuels}."
    )


def _fields(elevation: str) -> str:
    return f"Elevation is from {elevation}, fuels are" if elevation else "Elevation and fuels are"


def _cells(latitude: np.ndarray, longitude: np.ndarray) -> str:
    dx, dy = areas.cell_size(latitude, longitude)
    size = f"{dx:.4g} m" if abs(dx - dy) < 0.005 * dx else f"{dx:.4g} x {dy:.4g} m"
    return f"{len(longitude)} x {len(latitude)} cells of {size}"
