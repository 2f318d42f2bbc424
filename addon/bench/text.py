"""A text file of numbers -> float32 array, beside NumPy and pandas, each in its quicker form."""

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

SIDES = (36, 144, 720, 2880)
TILE = 720
HARD = 4000  # numbers
RIVALS = {
    "numpy.loadtxt": ("numpy.loadtxt, as float64 then cast", "numpy.loadtxt, as float32"),
    "pandas": ("pandas.read_csv, as float64 then cast", "pandas.read_csv, as float32"),
}
BOUNDS = {"numpy.loadtxt": 4.0, "pandas": 2.0}
MEGABYTES = 500.0  # a second


def grid_text(side: int, separator: str = " ") -> str:
    """`side` x `side` heat fluxes as "%.6e"; above TILE a side, the same tile repeated."""
    n = min(side, TILE)
    stream = io.StringIO()
    values = np.random.default_rng(1).lognormal(8, 3, (n, n))
    np.savetxt(stream, values, fmt="%.6e", delimiter=separator)
    repeats = side // n
    lines = [separator.join([line] * repeats) for line in stream.getvalue().splitlines()]
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
    """Percent of `values` that are not the float32 nearest to their text, by exact arithmetic."""
    words = text.split()
    found = np.asarray(values).ravel().astype(np.float32)
    return 100 * sum(_is_wrong(word, value) for word, value in zip(words, found, strict=True)) / len(words)


def _is_wrong(word: str, value: np.float32) -> bool:
    exact = Fraction(word)
    near = (np.nextafter(value, np.float32(-np.inf)), np.nextafter(value, np.float32(np.inf)))
    error = abs(Fraction(float(value)) - exact)
    return any(abs(Fraction(float(other)) - exact) < error for other in near)


def run(bench: Bench) -> None:
    """Files of growing size, with blanks and with commas; errors are of numbers that are hard to round."""
    with tempfile.TemporaryDirectory() as folder:
        hard = Path(folder) / "hard.txt"
        hard.write_text(hard_text())
        tools = _tools(bench, hard, " ")
        wrong = {tool.label: wrong_share(hard.read_text(), tool.call()) for tool in tools}
        bench.target(
            "numbers that are hard to round, not made the nearest float32", wrong[OURS], 0, "%", most=True
        )
        for side in SIDES:
            for separator, name in ((" ", ""), (",", ", commas")):
                path = Path(folder) / f"{side}.txt"
                path.write_text(grid_text(side, separator))
                rivals = (side <= 720 and not name) or bench.full
                _one_file(bench, f"{side} x {side}{name}", path, side, separator, wrong, rivals)


def _tools(bench: Bench, path: Path, separator: str, rivals: bool = True) -> list[Runner]:
    tools = [Runner(OURS, lambda: read_grid(path))]
    if not rivals:
        return tools
    blank = None if separator == " " else separator
    cast, direct = RIVALS["numpy.loadtxt"]
    tools += [
        Runner(cast, lambda: np.loadtxt(path, delimiter=blank).astype(np.float32)),
        Runner(direct, lambda: np.loadtxt(path, np.float32, delimiter=blank)),
    ]
    if pandas := bench.rival("pandas"):
        read = pandas.read_csv
        cast, direct = RIVALS["pandas"]
        tools += [
            Runner(cast, lambda: read(path, sep=separator, header=None).to_numpy(np.float32)),
            Runner(direct, lambda: read(path, sep=separator, header=None, dtype=np.float32).to_numpy()),
        ]
    return tools


def _one_file(
    bench: Bench, case: str, path: Path, side: int, separator: str, wrong: dict[str, float], rivals: bool
) -> None:
    tools = [
        Runner(tool.tool, tool.call, error=wrong[tool.label])
        for tool in _tools(bench, path, separator, rivals)
    ]
    found = bench.race(case, tools, side * side, "value", "% of hard numbers wrong")
    if case == "720 x 720":
        speed = found[OURS].speed(path.stat().st_size / 1e6)
        bench.target("720 x 720 text is read at", speed, MEGABYTES, "MB/s")
        for rival, forms in RIVALS.items():
            if best := _best(found, forms):
                bench.target(
                    f"speed of reading 720 x 720 text, over {rival}'s in the quicker of its two forms",
                    found[OURS].faster_than(best),
                    BOUNDS[rival],
                    "x",
                )


def _best(found: dict[str, Times], forms: tuple[str, ...]) -> Times | None:
    """The quicker of a rival's forms."""
    return min((found[form] for form in forms if form in found), key=lambda times: times.median, default=None)
