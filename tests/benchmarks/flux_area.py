"""Burned area and arrival times estimated from heat fluxes alone, for ellipses and circles of known area.

    .venv/bin/python tests/benchmarks/flux_area.py

Each of 5 x 5 parts of a cell burns as exp(-age / delay), with a delay of 2 or 10 minutes, or with --constant
at a constant rate for that time. A flux is the mean since the last output; outputs are 1, 5 or 15 minutes
apart. Prints mean, smallest and largest error for each cell size; of arrival times, these of the cells' mean.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import whole_run
from firetwin.run import info
from firetwin.run import opening as runs

CASES = ((30.0, 80), (75.0, 40), (150.0, 24))  # m, and cells along a side
PARTS, END, SPEED = 5, 3600.0, 0.3  # s; m/s


def main() -> None:
    """Measure all cases and print a Markdown table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--constant", action="store_true", help="fuel that burns at a constant rate")
    constant = parser.parse_args().constant
    print("| cells, m | outputs, min | cases | area: mean | least | most | arrival: mean | least | most |")
    print("|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    for (cell, cells), interval in itertools.product(CASES, (60.0, 300.0, 900.0)):
        errors, late = np.transpose(
            [
                measure(cell, cells, interval, lasts, wind, constant)
                for lasts, wind in itertools.product((120.0, 600.0), ((4.0, 0.0), None))
                if cells * cell > 2500.0 or wind
            ]
        )
        shown = " | ".join(
            [f"{100.0 * each:+.1f} %" for each in (errors.mean(), errors.min(), errors.max())]
            + [f"{each:+.0f} s" for each in (late.mean(), late.min(), late.max())]
        )
        print(f"| {cell:g} | {interval / 60.0:g} | {len(errors)} | {shown} |", flush=True)


def measure(
    cell: float, cells: int, interval: float, lasts: float, wind: tuple[float, float] | None, constant: bool
) -> tuple[float, float]:
    """Return the relative error of the burned area at the end of a fire, and of arrival times the mean, s."""
    times = tuple(np.arange(0.0, END + 1.0, interval).tolist())
    count = cells * PARTS
    metres = (np.arange(count) - (count - 1) / 2) * cell / PARTS
    came = whole_run._travel(*np.meshgrid(metres, metres), SPEED, wind)
    ages = [np.maximum(time - came, 0.0) for time in times]
    parts = [np.minimum(age / lasts, 1.0) if constant else 1.0 - np.exp(-age / lasts) for age in ages]
    heat = np.array(parts).reshape(len(times), cells, PARTS, cells, PARTS).mean((2, 4)) * 30e3 * lasts
    flux = np.diff(heat, axis=0, prepend=heat[:1]) / interval
    with tempfile.TemporaryDirectory() as name:
        folder = whole_run.write(Path(name) / "run", cell=cell, cells=cells, times=times, arrival=False)
        np.save(folder / "heat_flux.npy", flux.astype(np.float32))
        run = runs.open(folder)
        burned, arrival = info.burned(run, [END])[0], np.asarray(run.fuel_arrival_time(), np.float64)
    centres = (np.arange(len(arrival)) - (len(arrival) - 1) / 2) * cell * cells / len(arrival)
    late = arrival - whole_run._travel(*np.meshgrid(centres, centres), SPEED, wind)
    return burned / (np.count_nonzero(came <= END) * (cell / PARTS) ** 2) - 1.0, float(np.nanmean(late))


if __name__ == "__main__":
    main()
