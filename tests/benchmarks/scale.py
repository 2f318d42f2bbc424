"""Cost of a shot in runs of different sizes, and error of arrival times from coarse output.

    python tests/benchmarks/scale.py SAMPLE [--work DIR] [--minutes 240]

SAMPLE is the run of `firetwin sample`. Runs in DIR: `sample`, its minutes from `FIRST` on, and `split`, the
same fire with each cell split into 4 x 4. Each step runs in a separate process; its memory is the peak minus
the memory after imports. The shot lasts `SHOT` s.

Then the front computed from heat fluxes only, with output each minute and each quarter of an hour: its mean
and its outward distance from the sample's arrival times, and the error of the burned area.
"""

from __future__ import annotations

import argparse
import importlib
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from firetwin import memory
from firetwin.bench.timing import Stopwatch
from firetwin.run import opening as runs
from numpy.typing import NDArray

FIRST, SPLIT = 1000, 4  # minute of the sample's long run up the canyon; cells for each, along both axes
SHOT, EVERY = 3600.0, 30.0  # s
CELL = 74.0  # m, of the sample's fuel
SERIES = ("heat_flux", "temperature", "wind_east", "wind_north")


def emission(folder: Path) -> float:
    """Compute the sources at each time of the shot; return the seconds for one, after the first."""
    fire, times = _fire(folder)
    fire.sources(times[0])
    watch = Stopwatch()
    for moment in times:
        fire.sources(float(moment))
    return watch.read().seconds / len(times)


def interpolation(folder: Path) -> float:
    """Interpolate the flux at each time of the shot; return the seconds for one, after the first."""
    fire, times = _fire(folder)
    fire.flux.burning(times[0])
    watch = Stopwatch()
    for moment in times:
        fire.flux.at(float(moment))
    return watch.read().seconds / len(times)


STEPS: dict[str, Callable[[Path], float]] = {
    "emission": emission,
    "interpolation": interpolation,
}


def _fire(folder: Path) -> tuple:
    from firetwin.shot.fire.fire import Fire

    run = runs.open(folder)
    middle = 0.5 * (run.times[0] + run.times[-1])
    times = np.arange(middle, min(middle + SHOT, run.times[-1]), EVERY)
    return Fire(run, float(times[0]), float(times[-1])), times


def measure(step: str, folder: Path) -> dict[str, float]:
    """Run a step in a separate process; return seconds, CPU seconds, MB, and ms per time of the shot."""
    command = [sys.executable, __file__, str(folder), "--step", step]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def _step(name: str, folder: Path) -> None:
    importlib.import_module("firetwin.shot.fire.fire")
    before, watch = memory.peak(), Stopwatch()
    one = STEPS[name](folder)
    spent, held = watch.read(), memory.peak() - before
    found = {"seconds": spent.seconds, "cpu-s": spent.processor, "MB": held / 2**20}
    print(json.dumps(found | {"ms per time": one * 1000}))


def cut(
    sample: Path, out: Path, minutes: slice, split: int = 1, own: bool = True, series: bool = False
) -> Path:
    """Write some minutes of the sample, each cell split into `split` x `split`, with arrival times if `own`.

    A split run has no series but heat flux, unless `series`; its heights and arrival times are bilinear.
    """
    out.mkdir()
    toml = (sample / "run.toml").read_text().replace("interval_s = 60.0", _interval(minutes))
    if not own:
        toml = toml.replace('fuel_arrival_time = "s"\n', "")
    (out / "run.toml").write_text(toml)
    for path in sample.glob("*.npy"):
        values = np.load(path, mmap_mode="r")
        if path.stem == "fuel_arrival_time" and not own:
            continue
        if "itude" in path.stem:
            values = _finer(values, split)
        elif path.stem in SERIES:
            if split > 1 and path.stem != "heat_flux" and not series:
                continue
            values = values[minutes]
        if "itude" not in path.stem and split > 1:
            repeated = np.repeat(np.repeat(values, split, -2), split, -1)
            smooth = "elevation" in path.stem or "arrival" in path.stem
            values = _between(values, repeated, split) if smooth else repeated
        np.save(out / path.name, values)
    return out


def _between(values: NDArray, repeated: NDArray, split: int) -> NDArray:
    """Interpolate bilinearly between cell centres; take the cell's value if a neighbour is unknown."""
    values_between = values.astype(np.float64)
    for axis in (0, 1):
        count = values.shape[axis]
        at = np.clip((np.arange(count * split) + 0.5) / split - 0.5, 0, count - 1)
        low = np.minimum(at.astype(int), max(count - 2, 0))
        high = np.minimum(low + 1, count - 1)
        part = np.expand_dims(at - low, 1 - axis)
        values_between = (
            values_between.take(low, axis) * (1.0 - part) + values_between.take(high, axis) * part
        )
    return np.where(np.isfinite(values_between) & np.isfinite(repeated), values_between, repeated).astype(
        values.dtype
    )


def _interval(minutes: slice) -> str:
    count = len(range(*minutes.indices(1858)))
    begin, step = minutes.start or 0, minutes.step or 1
    return f"times_s = {[60.0 * (begin + step * i) for i in range(count)]}"


def _finer(axis: NDArray, split: int) -> NDArray:
    part = (np.arange(split) + 0.5) / split - 0.5
    return (axis[:, None] + part * (axis[-1] - axis[0]) / (len(axis) - 1)).ravel()


def front(sample: Path, arrivals: NDArray, moments: NDArray) -> tuple[float, float, float]:
    """Return the mean and the outward distance of a front, m, and the error of the last burned area, %."""
    own = np.load(sample / "fuel_arrival_time.npy").astype(np.float64)
    before = own < 0.0  # released its heat before the run began
    for _ in range(8):  # and its neighbours within the model's cells
        padded = np.pad(before, 1)
        before = padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:] | before
    off, out, more = [], [], 0.0
    for moment in moments:
        true, here = (own <= moment) & ~before, (arrivals <= moment) & ~before
        front = np.diff(own <= moment, axis=0), np.diff(own <= moment, axis=1)
        known = ~(before[1:] | before[:-1]), ~(before[:, 1:] | before[:, :-1])
        edges = sum(np.count_nonzero(part & there) for part, there in zip(front, known, strict=True))
        length = edges * np.pi / 4.0  # of a line in all directions, in cells
        off.append(CELL * np.count_nonzero(true != here) / length)
        out.append(CELL * (int(here.sum()) - int(true.sum())) / length)
        more = 100.0 * (here.sum() / true.sum() - 1.0)
    return float(np.mean(off)), float(np.mean(out)), float(more)


def main() -> None:
    """Measure and print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("sample", type=Path)
    parser.add_argument("--work", type=Path)
    parser.add_argument("--minutes", type=int, default=240)
    parser.add_argument("--step", choices=STEPS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.step:
        _step(given.step, given.sample)
        return
    with tempfile.TemporaryDirectory(dir=given.work) as name:
        work, minutes = Path(name), slice(FIRST, FIRST + given.minutes)
        folders = [
            cut(given.sample, work / "sample", minutes),
            cut(given.sample, work / "split", minutes, SPLIT),
        ]
        for folder in folders:
            for step in STEPS:
                found = min((measure(step, folder) for _ in range(3)), key=lambda each: each["seconds"])
                print(f"{folder.name:10}{step:16}" + "".join(f"{v:10.3f} {k}" for k, v in found.items()))
            shutil.rmtree(folder)
        for minutes_apart in (1, 15):
            thinned = slice(None, None, minutes_apart)
            folder = cut(given.sample, work / f"each{minutes_apart}", thinned, own=False)
            run = runs.open(folder)
            moments = np.append(np.arange(7620.0, run.times[-1] - 900.0, 1800.0), run.times[-1])
            mean, outwards, area = front(given.sample, np.asarray(run.fuel_arrival_time(), float), moments)
            off = f"front error {mean:.0f} m, outward {outwards:+.0f} m, area {area:+.1f} %"
            print(f"output each {minutes_apart:2} min: {off}")


if __name__ == "__main__":
    main()
