"""Solve the library of flames: `python -m firetwin.data.flames.solve [KIND ...]`.

Compiles the solver (`solver/`; needs a C++20 compiler and FFTW's single-precision library), runs it for each
kind and seed, and packs the frames. Equal settings give equal bytes on one machine; FFTW and the compiler may
round differently on another.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

from . import FOLDER, pack

SOURCES = FOLDER / "solver"
FLAGS = (
    "-std=c++20", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math",
)  # fmt: skip
SEEDS = (1, 2)

SIZES: dict[str, tuple[float, float, float]] = {
    "calm": (2.0, 1.6, 1.75),
    "breeze": (2.6, 1.6, 1.5),
    "wind": (3.2, 1.6, 1.2),
    "crown": (1.2, 1.2, 2.0),
}
"""Size of the box along x, y and z in units, which are about a flame length."""
CELLS: dict[str, tuple[int, int]] = {
    "calm": (52, 58),
    "breeze": (56, 56),
    "wind": (50, 50),
    "crown": (60, 60),
}
"""Cells to a unit for each seed: 45 to 72 to the flame length that comes out."""
CROWN = {"crown": 1, "crown_base": 0.1, "crown_top": 0.62, "crown_radius": 0.22}
KINDS: dict[str, dict[str, float]] = {
    "calm": {"spin": 4.2, "interval": 0.077, "front": 1.15, "inflow": 0.08, "eddies": 1.7},
    "breeze": {"spin": 4.0, "interval": 0.08, "front": 0.8, "inflow": 0.08, "eddies": 1.5, "wind": 0.4},
    "wind": {"spin": 3.6, "interval": 0.08, "front": 0.6, "inflow": 0.09, "eddies": 1.5, "wind": 1.03},
    "crown": {"spin": 3.4, "interval": 0.085, "front": 0.6, "inflow": 0.65, "eddies": 1.5} | CROWN,
}
"""Settings of the solver (`solver/settings.hpp`), by eye; winds for 0.4 and 1.0 sqrt(gL)."""
DEPTH = 0.35  # units of burning fuel behind the front
FRAMES = 32  # 2.5 sqrt(L / g)


def compile_solver(folder: Path, optimise: str = "-O3") -> Path:
    """Compile the solver in a folder and return its program."""
    compiler = os.environ.get("CXX") or shutil.which("g++") or shutil.which("clang++")
    if not compiler:
        raise SystemExit("solve: no C++ compiler (g++ or clang++) is installed")
    program = folder / "solver"
    unit = "".join(f'#include "{path}"\n' for path in sorted(SOURCES.glob("*.cpp")))  # headers are read once
    words = [compiler, optimise, *FLAGS, "-x", "c++", "-", "-o", str(program), "-lfftw3f"]
    subprocess.run(words, input=unit, text=True, check=True)
    return program


def settings_of(kind: str, seed: int, cells: int, frames: int) -> dict[str, Any]:
    """Return the settings of a block with `cells` to a unit."""
    shape = dict(zip(("nx", "ny", "nz"), (_even(size * cells) for size in SIZES[kind]), strict=True))
    fixed = {"depth": DEPTH, "cells": cells, "seed": seed, "frames": frames}
    return {**KINDS[kind], **shape, **fixed}


def _even(cells: float) -> int:
    """Round to a multiple of 8 cells, of which mip levels and quick transforms are made."""
    return 8 * round(cells / 8)


def run(program: Path, settings: dict[str, Any], folder: Path) -> pack.Solved:
    """Run the solver and return its frames and profiles."""
    out = folder / "frames"
    words = [f"{name}={value}" for name, value in settings.items()]
    subprocess.run([str(program), f"out={out}", *words], check=True)
    return pack.read_solved(out, settings)


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="python -m firetwin.data.flames.solve", description=__doc__)
    parser.add_argument(
        "kinds", nargs="*", default=list(KINDS), choices=list(KINDS), help="all if none is named"
    )
    parser.add_argument("--seeds", type=int, nargs="+", default=SEEDS, choices=SEEDS)
    parser.add_argument("--cells", type=int, help="cells to a unit of length, about a flame's")
    parser.add_argument("--frames", type=int, default=FRAMES)
    parser.add_argument("--out", type=Path, default=FOLDER, help="folder of the blocks")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = compile_solver(folder)
        for seed in options.seeds:
            for kind in options.kinds:
                begin = time.perf_counter()
                cells = options.cells or CELLS[kind][seed - 1]
                settings = settings_of(kind, seed, cells, options.frames)
                solved = run(program, settings, folder)
                path = options.out / f"{kind}_{seed}.npz"
                length = pack.save(path, solved)
                seconds, size = time.perf_counter() - begin, path.stat().st_size
                print(f"{path.name}: length {length:.3f}, {size / 1e6:.2f} MB, {seconds:.0f} s", flush=True)


if __name__ == "__main__":
    main()
