"""Text file of numbers -> float32 array, compared with NumPy and pandas, each in its faster form."""

from __future__ import annotations

import io
import tempfile
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

import numpy as np
from firetwin_core.run import read_grid
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner, Times

SIDE = 720
HARD = 4000  # numbers
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


def hard_text() -> str:
    """Write decimal numbers close to the midpoint of two float32, where rounding by way of float64 fails."""
    rng = np.random.default_rng(8)
    values = rng.lognormal(8, 3, HARD).astype(np.float32)
    with localcontext(prec=60):
        words = []
        for value in values:
            middle = (Decimal(float(value)) + Decimal(float(np.nextafter(value, np.float32(np.inf))))) / 2
            words.append(f"{middle * (1 + Decimal(int(rng.choice([-1, 1]))) / 10**25):f}")
    return "\n".join(" ".join(words[i : i + 40]) for i in range(0, HARD, 40)) + "\n"


def wrong_share(text: str, values: NDArray) -> float:
    """Return the percentage of `values` that are not the float32 nearest to their text (exact arithmetic)."""
    words = text.split()
    rounded = np.asarray(values).ravel().astype(np.float32)
    return 100 * sum(_is_wrong(word, value) for word, value in zip(words, rounded, strict=True)) / len(words)


def _is_wrong(word: str, value: np.float32) -> bool:
    exact = Fraction(word)
    near = (np.nextafter(value, np.float32(-np.inf)), np.nextafter(value, np.float32(np.inf)))
    error = abs(Fraction(float(value)) - exact)
    return any(abs(Fraction(float(other)) - exact) < error for other in near)


def run(bench: Bench) -> None:
    """Measure speed on a grid of the King Fire's fuel size, and errors on numbers that are hard to round."""
    with tempfile.TemporaryDirectory() as folder:
        hard, grid = Path(folder) / "hard.txt", Path(folder) / "grid.txt"
        hard.write_text(hard_text())
        wrong = {tool.label: wrong_share(hard.read_text(), tool.call()) for tool in tools(bench, hard)}
        quantity = "Hard-to-round numbers not read as the nearest float32"
        bench.target(quantity, wrong[OURS], 0, "%", most=True)
        grid.write_text(grid_text(SIDE))
        race(bench, grid, SIDE, wrong)


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


def race(bench: Bench, path: Path, side: int, wrong: dict[str, float]) -> None:
    """Read `side` x `side` values of a file with every tool; `wrong` is the error (%) of each."""
    case = f"{side} x {side}"
    runners = [Runner(tool.tool, tool.call, error=wrong[tool.label]) for tool in tools(bench, path)]
    times = bench.race(case, runners, side * side, "value", "% of hard numbers wrong")
    bench.target(f"Read speed, {case} text", times[OURS].speed(path.stat().st_size / 1e6), MEGABYTES, "MB/s")
    for rival, forms in RIVALS.items():
        if best := _best(times, forms):
            quantity = f"Read speed / {rival} in its faster form, {case} text"
            bench.target(quantity, times[OURS].faster_than(best), BOUNDS[rival], "x")


def _best(found: dict[str, Times], forms: tuple[str, ...]) -> Times | None:
    """Return the times of the faster form of a competing tool."""
    return min((found[form] for form in forms if form in found), key=lambda times: times.median, default=None)
