"""Stations: time of searches among many resources, and error of arrival times from heat fluxes.

    .venv/bin/python tests/benchmarks/station_search.py RUN [--resources N]

RUN has `fuel_arrival_time`. Its arrival times are compared with those computed from heat fluxes only, at
random points that the fire reaches in both.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from firetwin.bench.timing import Stopwatch
from firetwin.run import opening as runs
from firetwin.stations import fire_arrival, reading, search, writing
from firetwin.stations.query import Query

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

from random_stations import CENTRE, NOON, random_stations

STATION_FILE = 40_000
REPEATS = 5
SEARCHES = {
    "60 km, 45 min, engines of types 1 to 3": Query(
        near=CENTRE, within_km=60.0, minutes=45.0, kinds=("engine",), types=("1", "2", "3"), at=NOON
    ),
    "all that are available": Query(near=CENTRE, at=NOON),
    "cheapest 20 t/h": Query(near=CENTRE, at=NOON, tonnes_per_hour=20.0),
    "cheapest 5,000 t/h": Query(near=CENTRE, tonnes_per_hour=5000.0),
    "first for a budget of 1,000,000": Query(near=CENTRE, budget=1e6),
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("run", metavar="RUN", type=Path, help="run folder with fuel_arrival_time")
    parser.add_argument("--resources", metavar="N", type=int, default=100_000, help="resources (100000)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        time_searches(Path(folder) / "stations.gpkg", options.resources)
        compare_arrivals(options.run, Path(folder) / "run")


def time_searches(path: Path, number: int) -> None:
    """Print the median times of reading a file and of searches in it."""
    writing.write(random_stations(1, max(number // 20, 1), number), path)
    seconds, station_file = timed(lambda: reading.read(path))
    print(f"{number:,} resources: read {seconds:.2f} s")
    seconds, _ = timed(lambda: (station_file.columns, station_file.codes, station_file.windows), 1)
    print(f"  arrays, once {seconds:.2f} s")
    for name, query in SEARCHES.items():
        seconds, found = timed(lambda query=query: search.survey(station_file, query))
        print(f"  {name}: {seconds:.3f} s, {len(found.matches):,} listed")


def timed(work: Callable, repeats: int = REPEATS) -> tuple[float, object]:
    """Return the median seconds of a call, and its result."""
    every = []
    for _ in range(repeats):
        watch = Stopwatch()
        made = work()
        every.append(watch.read().seconds)
    return statistics.median(every), made


def compare_arrivals(folder: Path, copy: Path) -> None:
    """Print the errors of arrival times from heat fluxes."""
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns(f"{fire_arrival.ARRIVAL_FIELD}*"))
    own, flux = runs.open(folder), runs.open(copy)
    rng = np.random.default_rng(1)
    latitude, longitude = (
        rng.uniform(axis.min(), axis.max(), STATION_FILE) for axis in (own.fuel_latitude, own.fuel_longitude)
    )
    true, sampled = (fire_arrival.sample(run, latitude, longitude) for run in (own, flux))
    both = (true.state == fire_arrival.REACHED) & (sampled.state == fire_arrival.REACHED)
    error = (sampled.time - true.time)[both] / 60.0
    within = ((sampled.earliest <= true.time) & (true.time <= sampled.latest))[both]
    wide, narrow = (np.median((each.latest - each.earliest)[both]) / 60.0 for each in (sampled, true))
    before = true.state == fire_arrival.BEFORE
    print(f"{both.sum():,} places; model output every {np.median(np.diff(own.times)):.0f} s")
    print(f"  mean absolute error {np.abs(error).mean():.0f} min, bias {error.mean():+.1f} min")
    print(f"  between earliest and latest: {100.0 * within.mean():.0f} %; median width {wide:.0f} min")
    print(f"  median width with fuel_arrival_time {narrow:.0f} min")
    missed = (true.state == fire_arrival.REACHED) & (sampled.state == fire_arrival.NOT_REACHED)
    added = (true.state == fire_arrival.NOT_REACHED) & (sampled.state == fire_arrival.REACHED)
    print(f"  reached, but never by fluxes: {missed.sum():,}; never, but reached by fluxes: {added.sum():,}")
    never = before & (sampled.state == fire_arrival.NOT_REACHED)
    print(f"  burned before the run: {before.sum():,}, never by fluxes: {never.sum():,}")


if __name__ == "__main__":
    main()
