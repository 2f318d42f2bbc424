"""Run of one member: `firetwin convert ENSEMBLE --member NAME`; heat comes from fuel and arrival times."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import input_error
from ..models import companion_rasters, from_arrival_time
from ..models.grid import Grid
from ..models.model import Model, Options
from . import ensemble

NAME = "an ensemble"


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
        None of the paths is an ensemble, or it has no such member.
    """
    folder = next((path for path in paths if ensemble.sniff(path)), None)
    if folder is None:
        raise input_error(
            paths[0], "is not an ensemble; make one: firetwin convert IN --members --out ENSEMBLE"
        )
    found = ensemble.open(folder)
    names = [member.name for member in found.members]
    if name not in names:
        known = ", ".join(names[:20]) + (", ..." if len(names) > 20 else "")
        raise input_error(folder, f'has no member "{name}"; choose one of {known}')
    arrival = found.arrival(names.index(name)).astype(np.float64)
    notes = [f"member {name} of {len(names)}, {found.manifest.name}"]
    if np.isnan(arrival).any():
        notes.append("cells that the member did not simulate do not burn")
    maps = from_arrival_time.Maps(np.where(np.isfinite(arrival), arrival, np.nan))
    said = replace(options, start=options.start or found.issued, zone=options.zone or found.manifest.zone)
    land = companion_rasters.find([path for path in paths if path != folder])
    grid = Grid(found.latitude, found.longitude)
    model = from_arrival_time.model(maps, grid, land, said, found.manifest.model, [folder], notes)
    model.name, model.zone = f"{found.manifest.name}, member {name}", said.zone
    return model
