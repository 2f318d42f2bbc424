"""Cached data of the station list and map: station file and run, read in a thread."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import bpy
from firetwin_core.run import Run

from ..errors import Error
from ..run import readers
from ..shot.runs.run_head import Head
from ..shot.terrain.elevation import Elevation
from ..stations import fire_arrival, ignition, picture, reading
from ..stations.station_file import StationFile
from . import job


class StationKey(NamedTuple):
    """Station file and run folder, with their modification times, ns."""

    file: Path
    file_changed: int
    run: Path | None
    run_changed: int


@dataclass(frozen=True)
class Loaded:
    """Station file, and the run if there is one.

    Attributes
    ----------
    arrivals
        Arrival of the fire at each station.
    ignition
        Ignition point, degrees; None: unknown.
    plan
        Static content of the map; None without stations and run.
    problem
        Error of the run; empty without an error.
    """

    station_file: StationFile
    run: Run | None = None
    arrivals: fire_arrival.Arrivals | None = None
    ignition: tuple[float, float] | None = None
    head: Head | None = None
    plan: picture.MapPicture | None = None
    problem: str = ""


_known: dict[StationKey, Loaded | str] = {}
_reading: threading.Thread | None = None


def key(panel: bpy.types.PropertyGroup) -> StationKey | None:
    """Return the key of the files in the panel; None if the file is missing."""
    if not panel.stations.file:
        return None
    file, run = Path(bpy.path.abspath(panel.stations.file)), None
    if panel.run and readers.folder.sniff(folder := Path(bpy.path.abspath(panel.run))):
        run = folder
    try:
        changed = file.stat().st_mtime_ns
        return StationKey(
            file, changed, run, readers.folder.changing_file(run).stat().st_mtime_ns if run else 0
        )
    except OSError:
        return None


def get(wanted: StationKey) -> Loaded | str | None:
    """Return the data, or an error message; None while a thread reads the files.

    Without a window the files are read immediately.
    """
    global _reading
    if wanted in _known:
        return _known[wanted]
    if bpy.app.background:
        _read(wanted)
        return _known[wanted]
    if _reading is None or not _reading.is_alive():
        _reading = threading.Thread(target=_read, args=(wanted,), name="Firetwin stations", daemon=True)
        _reading.start()
    return None


def kinds() -> list[str]:
    """Return the kinds of resources in the file that was read last."""
    return sorted(
        {
            each.kind
            for found in _known.values()
            if isinstance(found, Loaded)
            for each in found.station_file.types
        }
    )


def clear() -> None:
    """Discard the cached data."""
    _known.clear()


def _read(wanted: StationKey) -> None:
    try:
        found: Loaded | str = load(wanted.file, wanted.run)
    except Exception as error:
        found = job.describe_error(error)
    _known.clear()
    _known[wanted] = found


def load(file: Path, folder: Path | None) -> Loaded:
    """Read a station file, and a run if there is one; an error of the run is stored in `problem`.

    Raises
    ------
    InputError
        The station file cannot be read.
    """
    station_file = reading.read(file)
    if folder is None:
        return Loaded(station_file, plan=picture.prepare_map(None, *station_file.positions))
    try:
        run = readers.open(folder)
        ground = picture.RunTerrain(
            run.fuel_latitude, run.fuel_longitude, Elevation(run).fuel, run.fuel_arrival_time()
        )
        arrivals = fire_arrival.sample(run, *station_file.positions)
        began = ignition.find(run)
    except (Error, OSError, ValueError, RuntimeError) as error:
        plan = picture.prepare_map(None, *station_file.positions)
        return Loaded(station_file, plan=plan, problem=job.describe_error(error))
    plan = picture.prepare_map(ground, *station_file.positions)
    return Loaded(station_file, run, arrivals, began and began[0], Head(run), plan)
