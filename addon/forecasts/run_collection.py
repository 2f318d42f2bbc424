"""Members of ensembles as runs (see `run.collections`); heat comes from fuel and arrival times."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import input_error
from ..run.models import companion_rasters, from_arrival_time
from ..run.models.grid import Grid
from ..run.models.model import Model, Options
from .ensemble import ensemble
from .ensemble.ensemble import sniff

__all__ = ["names", "read", "sniff"]


def names(path: Path) -> list[str]:
    """Return the names of the members."""
    return [member.name for member in ensemble.open(path).members]


def read(paths: list[Path], options: Options, name: str) -> Model:
    """Read a member as a model.

    Parameters
    ----------
    paths
        An ensemble, and rasters or a landscape (LCP) of elevation and fuels.
    name
        Name of the member.

    Raises
    ------
    InputError
        The ensemble has no such member.
    """
    folder = next(filter(sniff, paths))
    forecast = ensemble.open(folder)
    every = [member.name for member in forecast.members]
    if name not in every:
        listed = ", ".join(every[:20]) + (", ..." if len(every) > 20 else "")
        raise input_error(folder, f'has no member "{name}"; choose one of {listed}')
    arrival = forecast.arrival(every.index(name)).astype(np.float64)
    notes = [f"member {name} of {len(every)}, {forecast.manifest.name}"]
    if np.isnan(arrival).any():
        notes.append("cells that the member did not simulate do not burn")
    maps = from_arrival_time.Maps(np.where(np.isfinite(arrival), arrival, np.nan))
    said = replace(
        options, start=options.start or forecast.issued, zone=options.zone or forecast.manifest.zone
    )
    land = companion_rasters.find([path for path in paths if path != folder])
    grid = Grid(forecast.latitude, forecast.longitude)
    model = from_arrival_time.model(maps, grid, land, said, forecast.manifest.model, [folder], notes)
    model.name, model.zone = f"{forecast.manifest.name}, member {name}", said.zone
    return model
