"""How fast are a model's files made into a run, and in how much memory? Needs the extra "models".

    python tests/benchmarks/convert.py [--frames 20] [--side 2000] [--compressed] [--turn 0] [--flux]

Files of the Community Fire Behavior Model's structure (heat flux, wind along both axes of the grid, burned
share, level function) are written, or with --flux CF netCDF files of ten heat fluxes each; then converted in
a process of their own. Prints megabytes of numbers a second, of the fields that move and of all that is read,
by the clock and by processor time, and peak memory.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from datetime import datetime, timedelta
from pathlib import Path

import netCDF4
import numpy as np

CHILD = """
import json, resource, sys
from firetwin.jobs import convert
paths, out = json.loads(sys.argv[1])
convert.in_process(paths, out, ["", "", "", 0.0])
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def main() -> None:
    """Write, convert, print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--side", type=int, default=2000)
    parser.add_argument("--compressed", action="store_true", help="deflate, as some runs are stored")
    parser.add_argument("--turn", type=float, default=0.0, help="degrees that the grid is turned by")
    parser.add_argument("--flux", action="store_true", help="a CF series of heat fluxes alone")
    parser.add_argument("--folder", type=Path, help="where the files go (a temporary one)")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(dir=options.folder))
    try:
        if options.flux:
            paths = [str(series(folder, frame, options)) for frame in range(0, options.frames, 10)]
        else:
            paths = [str(write(folder, frame, options)) for frame in range(options.frames)]
        before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        words = [sys.executable, "-c", CHILD, json.dumps([paths, str(folder / "run")])]
        done = subprocess.run(words, check=True, capture_output=True, text=True)
        seconds = time.perf_counter() - begun
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        moving = (1 if options.flux else 3) * 4 * options.frames * options.side**2 / 1e6
        read = moving if options.flux else moving * 4 / 3
        print(
            f"{options.frames} times of {options.side} x {options.side}: {moving:.0f} MB of fields written,"
        )
        print(f"{read:.0f} MB of numbers read, in {seconds:.1f} s, {busy:.1f} s of processor time")
        for name, amount in (("written", moving), ("read", read)):
            print(
                f"{name:<8} {amount / seconds:6.0f} MB/s by the clock, {amount / busy:6.0f} MB/s of one core"
            )
        print(f"peak memory {int(done.stdout) / 1e3:.0f} MB")
    finally:
        shutil.rmtree(folder)


def series(folder: Path, first: int, options: argparse.Namespace) -> Path:
    """Ten times of a heat flux, as CF files are: one variable with its axes."""
    side, path = options.side, folder / f"flux_{first:06}.nc"
    x = np.arange(side) * 10.0 + np.zeros((side, 1))
    times = range(first, min(first + 10, options.frames))
    with netCDF4.Dataset(path, "w") as file:
        for name, size in (("time", len(times)), ("latitude", side), ("longitude", side)):
            file.createDimension(name, size)
            units = {
                "time": "seconds since 2020-07-01",
                "latitude": "degrees_north",
                "longitude": "degrees_east",
            }
            variable = file.createVariable(name, "f8", (name,))
            variable.units = units[name]
            low = {"time": 0.0, "latitude": 39.0, "longitude": -120.0}[name]
            variable[:] = 30.0 * np.array(times) if name == "time" else low + 1e-4 * np.arange(side)
        deflate = {"zlib": True, "complevel": 1} if options.compressed else {}
        flux = file.createVariable("heat_flux", "f4", ("time", "latitude", "longitude"), **deflate)
        for row, frame in enumerate(times):
            level = x - 90.0 * frame - 200.0 + 40.0 * np.sin(np.arange(side) / 90.0)[:, None]
            flux[row] = np.where(level < 0, 5e4 * np.exp(level / 100.0), 0.0)
    return path


def write(folder: Path, frame: int, options: argparse.Namespace) -> Path:
    """One time: a front that moves east over rolling ground."""
    side, cell = options.side, 10.0
    x, y = np.meshgrid(np.arange(side) * cell, np.arange(side) * cell)
    c, s = np.cos(np.radians(options.turn)), np.sin(np.radians(options.turn))
    level = x - 3.0 * 30.0 * frame - 200.0
    moment = datetime(2020, 7, 1) + timedelta(seconds=30 * frame)
    path = folder / f"fire_output_{moment:%Y-%m-%d_%H:%M:%S}.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("nx", side)
        file.createDimension("ny", side)
        for name, values in {
            "lats": 39.0 + (s * x + c * y) / 111_000.0,
            "lons": -120.0 + (c * x - s * y) / 86_000.0,
            "fgrnhfx": np.where(level < 0, 5e4 * np.exp(level / 100.0), 0.0),
            "lfn": level,
            "fire_area": np.clip(0.5 - level / cell, 0.0, 1.0),
            "uf": 3.0 + np.sin(x / 300.0),
            "vf": 1.0 + np.cos(y / 300.0),
            "zsf": 900.0 + 50.0 * np.sin(y / 900.0),
        }.items():
            deflate = {"zlib": True, "complevel": 1} if options.compressed else {}
            file.createVariable(name, "f4", ("ny", "nx"), **deflate)[:] = values
    return path


if __name__ == "__main__":
    main()
