"""Text grid -> float32 array, beside NumPy and pandas."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Callable
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

import numpy as np
from firetwin_core.run import read_grid
from numpy.typing import NDArray

from .harness import OURS, Bench, threads

SIDES = (36, 144, 720, 2880)
TILE = 720
HARD = 4000  # numbers


def grid_text(side: int) -> str:
    """`side` x `side` heat fluxes as "%.6e"; above TILE a side, the same tile repeated."""
    n = min(side, TILE)
    stream = io.StringIO()
    np.savetxt(stream, np.random.default_rng(1).lognormal(8, 3, (n, n)), fmt="%.6e")
    repeats = side // n
    lines = [" ".join([line] * repeats) for line in stream.getvalue().splitlines()]
    return "\n".join(lines * repeats) + "\n"


def hard_text() -> str:
    """Numbers a hair beside the middle between two float32: wrong when rounded by way of a float64."""
    rng = np.random.default_rng(8)
    values = rng.lognormal(8, 3, HARD).astype(np.float32)
    with localcontext(prec=60):
        words = []
        for value in values:
            middle = (Decimal(float(value)) + Decimal(float(np.nextafter(value, np.float32(np.inf))))) / 2
            words.append(f"{middle * (1 + Decimal(int(rng.choice([-1, 1]))) / 10**25):f}")
    return "\n".join(" ".join(words[i : i + 40]) for i in range(0, HARD, 40)) + "\n"


def wrong_share(text: str, values: NDArray) -> float:
    """Share of `values` that are not the float32 nearest to their text, by exact arithmetic."""
    words = text.split()
    found = np.asarray(values).ravel().astype(np.float32)
    return sum(_is_wrong(word, value) for word, value in zip(words, found, strict=True)) / len(words)


def _is_wrong(word: str, value: np.float32) -> bool:
    exact = Fraction(word)
    near = (np.nextafter(value, np.float32(-np.inf)), np.nextafter(value, np.float32(np.inf)))
    error = abs(Fraction(float(value)) - exact)
    return any(abs(Fraction(float(other)) - exact) < error for other in near)


def run(bench: Bench) -> None:
    """Files of growing size; errors are of numbers that are hard to round, the same for all sizes."""
    with tempfile.TemporaryDirectory() as folder:
        hard = Path(folder) / "hard.txt"
        hard.write_text(hard_text())
        wrong = {tool: wrong_share(hard.read_text(), read()) for tool, read in _tools(bench, hard).items()}
        for side in SIDES:
            path = Path(folder) / f"{side}.txt"
            path.write_text(grid_text(side))
            _one_size(bench, side, path, wrong)


def _tools(bench: Bench, path: Path) -> dict[str, Callable[[], NDArray]]:
    tools = {OURS: lambda: read_grid(path), "numpy.loadtxt": lambda: np.loadtxt(path, np.float32)}
    if pandas := bench.rival("pandas"):
        read = pandas.read_csv
        tools["pandas"] = lambda: read(path, sep=" ", header=None).to_numpy(np.float32)
    return tools


def _one_size(bench: Bench, side: int, path: Path, wrong: dict[str, float]) -> None:
    seconds = {}
    for tool, read in _tools(bench, path).items():
        with threads(1):
            seconds[tool] = bench.best(read, 20 if side < 720 else 3)
        case, megabytes = f"{side} x {side}", path.stat().st_size / 1e6
        bench.row(
            case,
            tool,
            seconds[tool],
            side * side,
            "value",
            error=wrong[tool],
            error_unit="share of hard numbers wrong",
        )
        if side == 720 and tool == OURS:
            bench.target("every value the nearest float32", wrong[tool], 0, "share", most=True)
            bench.target("one thread reads", megabytes / seconds[tool], 500, "MB/s")
    if side == 720:
        ours = seconds[OURS]
        bench.target("faster than numpy.loadtxt", seconds["numpy.loadtxt"] / ours, 4, "x")
        if "pandas" in seconds:
            bench.target("faster than pandas", seconds["pandas"] / ours, 2, "x")
