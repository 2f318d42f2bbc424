"""Text file of numbers -> float32 array, compared with NumPy and pandas, each in its faster form."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path

import numpy as np
from firetwin_core.run import read_grid

from .harness import OURS, Bench
from .timing import Runner, Times

SIDE = 720
RIVALS = {
    "numpy.loadtxt": ("numpy.loadtxt, as float64 then cast", "numpy.loadtxt, as float32"),
    "pandas": ("pandas.read_csv, as float64 then cast", "pandas.read_csv, as float32"),
}
BOUNDS = {"numpy.loadtxt": 4.0, "pandas": 2.0}
MEGABYTES = 500.0  # a second


def grid_text(side: int) -> str:
    """Write `side` x `side` heat fluxes as "%.6e"."""
    stream = io.StringIO()
    np.savetxt(stream, np.random.default_rng(1).lognormal(8, 3, (side, side)), fmt="%.6e")
    return stream.getvalue()


def run(bench: Bench) -> None:
    """Measure speed on a grid of the King Fire's fuel size."""
    with tempfile.TemporaryDirectory() as folder:
        grid = Path(folder) / "grid.txt"
        grid.write_text(grid_text(SIDE))
        race(bench, grid, SIDE)


def tools(bench: Bench, path: Path) -> list[Runner]:
    """Return the readers of this file, each in its two forms."""
    cast, direct = RIVALS["numpy.loadtxt"]
    readers = [
        Runner(OURS, lambda: read_grid(path)),
        Runner(cast, lambda: np.loadtxt(path).astype(np.float32)),
        Runner(direct, lambda: np.loadtxt(path, np.float32)),
    ]
    if pandas := bench.rival("pandas"):
        read = pandas.read_csv
        cast, direct = RIVALS["pandas"]
        readers += [
            Runner(cast, lambda: read(path, sep=" ", header=None).to_numpy(np.float32)),
            Runner(direct, lambda: read(path, sep=" ", header=None, dtype=np.float32).to_numpy()),
        ]
    return readers


def race(bench: Bench, path: Path, side: int) -> None:
    """Read `side` x `side` values of a file with every tool."""
    case = f"{side} x {side}"
    times = bench.race(case, tools(bench, path), side * side, "value")
    bench.target(f"Read speed, {case} text", times[OURS].speed(path.stat().st_size / 1e6), MEGABYTES, "MB/s")
    for rival, forms in RIVALS.items():
        if best := _best(times, forms):
            quantity = f"Read speed / {rival} in its faster form, {case} text"
            bench.target(quantity, times[OURS].faster_than(best), BOUNDS[rival], "x")


def _best(found: dict[str, Times], forms: tuple[str, ...]) -> Times | None:
    """Return the times of the faster form of a competing tool."""
    return min((found[form] for form in forms if form in found), key=lambda times: times.median, default=None)
