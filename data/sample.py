"""Expand the stored sample fire to a run folder: `firetwin sample OUT`."""

from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, input_error
from ..files import read_text
from ..limits import SETTINGS_BYTES
from ..staging import staging
from ..toml_text import loads
from . import air, members, release, runtext, stored, weather
from .grid import (
    FUEL_CELL_SIZE,
    FUEL_CELLS,
    MODEL_CELL_SIZE,
    MODEL_CELLS,
    axes,
    block_mean,
)

NAME = "King Fire 2014 (synthetic sample)"
INTERVAL = 60.0  # s
EARLY = 360  # minutes of the early run, which begins at the ignition
FIELDS = ("heat_flux", "temperature", "wind_east", "wind_north")
FORMATS = ("npy", "text")


def write(
    out: Path,
    frames: int | None = None,
    format: str = "npy",
    progress: Callable[[int, int], None] | None = None,
    pace: float = 1.0,
    member: int = 0,
    overwrite: bool = False,
    early: bool = False,
) -> None:
    """Write the sample run to the folder `out`.

    Parameters
    ----------
    out
        Created if missing; an earlier sample run is replaced, other content is rejected. Files of others in
        the folder stay.
    frames
        Number of output times, spread evenly over the minutes of the run; all of them if None.
    format
        "npy": one array per field. "text": one file per field and time.
    progress
        Called with the number of output times done and their total.
    pace
        Speed of the fire / speed in the sample, from the start on: an invented what-if for comparisons.
    member
        Number of the member of the synthetic ensemble (members.py); 0 is the sample's fire.
    overwrite
        Also replace changed files of an earlier sample run.
    early
        Write the first hours of the fire, days before the sample. Their spread within the first perimeter is
        invented; the weather is that of the same time of day.

    Raises
    ------
    firetwin_core.InputError
        `out` exists and is not a sample run, `frames` or `format` is out of range, or the early run has
        another pace or member.
    """
    out = Path(out)
    _refuse_strangers(out)
    if format not in FORMATS:
        raise input_error(out, f"unknown format {format!r}; choose {' or '.join(FORMATS)}")
    if early and (pace != 1.0 or member):
        raise input_error(out, "the early run has no other pace and members; leave them out")
    sample = members.sample_of(member)
    sample, minutes = _early(sample) if early else (at_pace(sample, pace), np.arange(stored.MINUTES + 1))
    which = [f"member {member:02}"] * bool(member) + [f"{pace:g} of its pace"] * (pace != 1.0)
    minutes = _chosen(out, minutes, frames)
    with staging(out, overwrite, is_run=True) as work:
        _write(work, sample, minutes, format, progress, which + ["first hours"] * early)


def _write(
    out: Path,
    sample: stored.Sample,
    minutes: NDArray[np.int64],
    format: str,
    progress: Callable[[int, int], None] | None,
    which: list[str],
) -> None:
    """Write a run that begins at the first of the `minutes` of a sample."""
    writer = runtext.NpyWriter(out) if format == "npy" else runtext.TextWriter(out)
    for name, values in _static(sample, minutes[0] * INTERVAL).items():
        writer.field(name, values)
    with writer.series(FIELDS, len(minutes), (MODEL_CELLS, MODEL_CELLS)) as put:
        for done, values in enumerate(frames_of(sample, minutes)):
            put(done, values)
            if progress:
                progress(done + 1, len(minutes))
    (out / "run.toml").write_text(_run_toml(minutes, which), encoding="utf-8", newline="\n")


def frames_of(sample: stored.Sample, minutes: NDArray[np.int64]) -> Iterator[tuple[NDArray, ...]]:
    """Yield heat flux, temperature, wind east and north (ny, nx) at each of the ascending `minutes`.

    Heat flux is the mean over the minute that ends at the output time, so that over all minutes heat is
    conserved.
    """
    elevation = block_mean(sample.elevation)
    released, inflow = release.Released(release.burns(sample)), air.Inflow()
    before = None
    for minute in minutes:
        time = minute * INTERVAL
        if before is None or before != minute - 1:
            released.until(time - INTERVAL)
        before = minute
        flux = released.until(time) / (INTERVAL * MODEL_CELL_SIZE**2)
        east, north = weather.channelled(*weather.open_wind(time), sample.channel)
        more_east, more_north = inflow.wind(flux)
        east, north = east + more_east, north + more_north
        warm = weather.temperature(time, elevation) + air.warming(flux, np.hypot(east, north))
        yield flux, warm, east, north


def _chosen(out: Path, minutes: NDArray[np.int64], frames: int | None) -> NDArray[np.int64]:
    """Choose evenly spaced minutes; all of them if `frames` is None."""
    total = len(minutes)
    if frames is None:
        return minutes
    if not 1 <= frames <= total:
        raise input_error(out, f"{frames} frames requested; the sample run has 1 to {total}")
    return np.unique(np.rint(np.linspace(minutes[0], minutes[-1], frames)).astype(int))


def _refuse_strangers(out: Path) -> None:
    """Reject a folder that is not a sample run."""
    if not out.exists() or (out.is_dir() and not any(out.iterdir())):
        return
    try:
        run = loads(out, read_text(out / "run.toml", most=SETTINGS_BYTES))
        ours = str(run.get("name")).startswith(NAME) and run.get("synthetic") is True
    except (OSError, ValueError, InputError):
        ours = False
    if not ours:
        raise input_error(out, "exists and is not a sample run; name another folder")


def _static(sample: stored.Sample, begin: float) -> dict[str, NDArray]:
    """Return the fields of a sample that do not change; its run begins at `begin`, s."""
    latitude, longitude = axes(MODEL_CELLS, MODEL_CELL_SIZE)
    fuel_latitude, fuel_longitude = axes(FUEL_CELLS, FUEL_CELL_SIZE)
    return {
        "latitude": latitude,
        "longitude": longitude,
        "elevation": block_mean(sample.elevation).astype(np.float32),
        "fuel_latitude": fuel_latitude,
        "fuel_longitude": fuel_longitude,
        "fuel_elevation": sample.elevation,
        "fuel_arrival_time": (sample.arrival - begin).astype(np.float32),
        "surface_fuel": sample.surface,
        "canopy_fuel": sample.canopy,
    }


def at_pace(sample: stored.Sample, pace: float) -> stored.Sample:
    """Multiply every rate of spread of the sample by `pace`; the area burned before the start stays.

    In constant weather that would be the same fire; here it is invented.
    """
    if pace == 1.0:
        return sample
    arrival = np.where(sample.arrival > 0.0, sample.arrival / pace, sample.arrival)
    arrival[arrival > stored.MINUTES * INTERVAL] = np.nan
    return sample._replace(arrival=arrival)


def _early(sample: stored.Sample) -> tuple[stored.Sample, NDArray[np.int64]]:
    """Return the sample's fire of the first hours, and their minutes, which precede the sample's start."""
    first = int(np.floor(np.nanmin(sample.arrival) / INTERVAL))
    minutes = first + np.arange(EARLY + 1)
    arrival = np.where(sample.arrival <= minutes[-1] * INTERVAL, sample.arrival, np.nan)
    return sample._replace(arrival=arrival), minutes


def _run_toml(minutes: NDArray[np.int64], which: list[str]) -> str:
    heading = f'name = "{NAME}"\nsynthetic = true\nevent = "king_fire"'
    if which:
        heading = f'name = "{", ".join([NAME, *which])}"\nsynthetic = true'
    start = stored.START + timedelta(seconds=int(minutes[0] * INTERVAL))
    minutes = minutes - minutes[0]
    if len(minutes) > 1 and np.ptp(np.diff(minutes)) == 0:
        times = f"interval_s = {(minutes[1] - minutes[0]) * INTERVAL:.1f}"
    else:
        times = f"times_s = [{', '.join(f'{minute * INTERVAL:.1f}' for minute in minutes)}]"
    return f"""\
# Synthetic: no output of a fire-atmosphere model of this fire is public. Terrain is fitted to public spot
# heights and river lines with invented relief between them; fuels and weather are invented; the fire was
# simulated with pyretechnics and tuned so that burned areas follow the reported ones. Heat flux is the mean
# over the {INTERVAL:.0f} s that end at each time. Temperature and wind come from scaling laws, not a flow
# model.
{heading}
start = {start:%Y-%m-%dT%H:%M:%SZ}
{times}
mean_s = {INTERVAL:.1f}
vertical = "orthometric"

[units]
elevation = "m"
fuel_elevation = "m"
fuel_arrival_time = "s"
heat_flux = "W/m2"
temperature = "K"
wind_east = "m/s"
wind_north = "m/s"
surface_fuel = "kg/m2"
canopy_fuel = "kg/m2"

[source]
assumptions = [
  "terrain: fitted to public spot heights, with invented relief between them",
  "fuels and weather: invented",
  "spread: simulated, tuned to the reported areas",
]
"""
