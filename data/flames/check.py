"""Compare the blocks with measured flames: `python -m firetwin.data.flames.check [FOLDER] [--solve]`.

Prints a Markdown table. Temperatures, tilts and peaks are the blocks'; `--solve` solves coarse flames for
longer (minutes), for heat release and length. Formulas are quoted from handbooks (SFPE), McCaffrey's
from FDS's validation scripts.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import FOLDER, pack, solve

AIR = 1.2 * 1.005 * 293.0  # kJ/m3: density, specific heat and temperature of air
UNIT_HEAT = AIR * 9.81**0.5  # kW/m (lines) or kW (crowns) at heat 1 and L = 1 m
CONVECTED = 0.7  # share of the heat release
TEMPERATURE = 293.0  # K, of air
_COARSE = 28  # cells to a unit of flames that are solved for heat
_GAP = 0.15  # L, length under which a place does not count as burning
HEAT_OF_COMBUSTION = 18_000.0  # kJ/kg, of wood gas
Row = tuple[str, str, float, float]


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="python -m firetwin.data.flames.check", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=FOLDER)
    parser.add_argument("--solve", action="store_true", help="solve coarse flames too, for heat and length")
    options = parser.parse_args()
    print("| flame | quantity | source | block | measured flames | difference |\n|---|---|---|--:|--:|--:|")
    for path in sorted(options.folder.glob("*_[0-9].npz")):
        for row in rows(path):
            print(format_row(path.stem, row))
    if options.solve:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            program = solve.compile_solver(folder)
            for kind in solve.KINDS:
                for row in coarse_rows(kind, program, folder):
                    print(format_row(kind, row), flush=True)


def format_row(name: str, row: Row) -> str:
    """Return a row of the table."""
    quantity, source, value, measured = row
    both = (
        f"{value:.3g} | {measured:.3g} | {100 * (value / measured - 1):+.0f} %"
        if measured
        else f"{value:.3g} | - | -"
    )
    return f"| {name} | {quantity} | {source} | {both} |"


def rows(path: Path) -> Iterator[Row]:
    """Yield quantity, source, value of the block and of measured flames (0: none), all of one block."""
    with np.load(path, allow_pickle=False) as stored:
        block = {name: stored[name] for name in stored.files}
    crown = bool(block["crown"].any())
    tips = pack.find_tips(block["codes"], float(block["cell"]), base(block), crown)
    burning = float((tips.length > _GAP).mean())
    if not crown:
        yield "burning share of the line", "-", burning, 0.0
        yield "spacing of peaks, L", "Finney et al. 2013: in proportion to L", spacing(tips, block), 0.0
    if block["wind"]:
        tilt = float(np.degrees(np.arctan2(tips.median(tips.x), tips.median(tips.height))))
        yield "tilt", "Albini 1981, tan A = 1.22 U / sqrt(gH)", tilt, albini(block, tips)
    else:
        yield from temperatures(block, burning)
    if not crown and not block["wind"]:
        yield puffing(block)


def coarse_rows(kind: str, program: Path, folder: Path) -> Iterator[Row]:
    """Yield rows of a coarse flame of one kind that is solved for long, so that its means are steady."""
    settings = solve.settings_of(kind, 1, _COARSE, 100) | {"interval": 0.2}
    solved = solve.run(program, settings, folder)
    length, crown = pack.flame_length(solved), kind == "crown"
    tips = pack.find_tips(solved.codes, 1.0 / _COARSE, pack.base_of(settings), crown)
    across = settings["ny"] / _COARSE if crown else 1.0 / float((tips.length > _GAP * length).mean())
    heat = solved.heat * across / length ** (2.5 if crown else 1.5) * UNIT_HEAT / CONVECTED
    if crown:
        bottom, radius = settings["crown_base"] / length, settings["crown_radius"] / length
        yield (
            "length above the foliage's base, L",
            "Heskestad 1983",
            1.0 - bottom,
            0.235 * heat**0.4 - 2.04 * radius,
        )
    else:
        yield "length, L", "Thomas 1963", 1.0, 0.0266 * heat ** (2.0 / 3.0)
    if "wind" in settings:
        yield from tilts(tips, settings["wind"] / length**0.5, heat)


def base(block: dict[str, NDArray]) -> float:
    """Return x of the middle of the burning base, in L from the first face."""
    return float(block["front"]) - 0.5 * float(block["depth"])


def albini(block: dict[str, NDArray], tips: pack.Tips) -> float:
    """Return Albini's (1981) tilt in degrees, with the height of the tip as that of the flame."""
    return float(np.degrees(np.arctan(1.22 * float(block["wind"]) / tips.median(tips.height) ** 0.5)))


def tilts(tips: pack.Tips, wind: float, heat: float) -> Iterator[Row]:
    """Yield the tilt (degrees) of the median tip against two correlations for `heat` (kW/m at L = 1 m)."""
    tilt = float(np.degrees(np.arctan2(tips.median(tips.x), tips.median(tips.height))))
    scaled = wind / (heat / HEAT_OF_COMBUSTION / 1.2 / 9.81**0.5) ** (1.0 / 3.0)
    for source, cosine in (
        ("AGA 1973, cos A = u^(-1/2)", scaled**-0.5),
        ("Thomas 1963, cos A = 0.7 u^(-0.49)", 0.7 * scaled**-0.49),
    ):
        yield "tilt", source, tilt, float(np.degrees(np.arccos(min(1.0, cosine))))


def temperatures(block: dict[str, NDArray], burning: float) -> Iterator[Row]:
    """Yield the mean temperature excess (K) on the axis at three heights against McCaffrey (1979).

    His fires are round; a line has the zones of a round flame of its length: z / Q^(2/5) is 0.2 at the tip.
    """
    height = (np.arange(len(block["excess"])) + 0.5) * float(block["cell"])
    bottom = float(block["crown"][0])
    for zone, at in (("continuous, 0.3 L", 0.3), ("intermittent, 0.7 L", 0.7), ("plume, 1.2 L", 1.2)):
        scaled = 0.2 * at
        measured = (
            800.0 if scaled < 0.08 else 63.0 / scaled if scaled < 0.2 else 21.6 * scaled ** (-5.0 / 3.0)
        )
        value = np.interp(bottom + at * (1.0 - bottom), height, block["excess"]) * TEMPERATURE / burning
        yield f"excess, K: {zone}", "McCaffrey 1979", float(value), measured


def spacing(tips: pack.Tips, block: dict[str, NDArray]) -> float:
    """Return the mean distance (L) between peaks of the flame along the line that rise 0.1 L over troughs."""
    frames, _, ny, _ = block["codes"].shape
    peaks = sum(_count_peaks(line) for line in tips.length.reshape(frames, ny))
    return frames * ny * float(block["cell"]) / max(peaks, 1)


def _count_peaks(line: NDArray[np.float64], prominence: float = 0.1) -> int:
    """Count peaks of a periodic line that rise by `prominence` over the troughs at both sides."""
    line = np.roll(line, -int(line.argmin()))
    count, rising, extreme = 0, False, line[0]
    for value in (*line, line[0]):
        if rising and value < extreme - prominence:
            count, rising, extreme = count + 1, False, value
        elif not rising and value > extreme + prominence:
            rising, extreme = True, value
        else:
            extreme = max(extreme, value) if rising else min(extreme, value)
    return count


def puffing(block: dict[str, NDArray]) -> Row:
    """Return the frequency (sqrt(g / L)) of puffs against 0.5 sqrt(g / D) (Pagni 1990).

    It is the peak of the mean spectrum, times the frequency, of the burning volume of pieces of 8 cells along
    the line, without its trend. A loop of 2.7 sqrt(L / g) resolves frequencies to 0.4.
    """
    burning = (pack.mixture(block["codes"]) > 1.0).sum(axis=(1, 3))
    count = len(burning)
    pieces = burning.reshape(count, -1, 8).sum(axis=2).astype(float)
    time = np.arange(count) - 0.5 * (count - 1)
    pieces -= pieces.mean(axis=0) + np.outer(time, time @ pieces / (time @ time))
    power = (np.abs(np.fft.rfft(pieces * np.hanning(count)[:, None], axis=0)) ** 2).mean(axis=1)
    frequency = np.fft.rfftfreq(count, float(block["interval"]))
    peak = float(frequency[(frequency * power).argmax()])
    return "puffing, sqrt(g/L)", "Pagni 1990, 0.5 sqrt(g/D)", peak, 0.5 / float(block["depth"]) ** 0.5


if __name__ == "__main__":
    main()
