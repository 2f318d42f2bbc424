"""Cost of solving the smoke of a scene as a flow: time, memory and disk space.

    .venv/bin/python tests/benchmarks/solved_smoke.py examples/king_fire.toml [--frames 3] [--json]

Solves the flow up to the last of the first `--frames` frames (default: all) in a temporary cache, and paints
the last one. Prints wall-clock time, CPU time, the height of the smoke and its mass balance.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from dataclasses import replace
from pathlib import Path

import bpy  # noqa: F401 (Blender's own libraries come first)
import firetwin_core
import numpy as np
from firetwin import memory
from firetwin.bench.timing import Stopwatch
from firetwin.run import opening
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import sources
from firetwin.smoke.flow import Flow


def time_call(work, *arguments) -> tuple[float, float]:
    """Return wall-clock and CPU seconds of a call."""
    watch = Stopwatch()
    work(*arguments)
    spent = watch.read()
    return spent.seconds, spent.processor


def measure(scene: Path, frames: int, cache: Path) -> dict[str, float]:
    """Solve and paint; return all figures by name."""
    settings = scene_file.read(scene)
    settings = replace(settings, cache=cache, smoke=replace(settings.smoke, method="flow"))
    shot = Shot(settings, opening.open(settings.run))
    source = sources.select(shot)
    solved: Flow = source.flow
    last = min(frames or shot.frames.count, shot.frames.count)
    result = {"boxes": float(len(solved.domains))}
    result["solve_s"], result["solve_processor_s"] = time_call(solved.ready, last)
    live = solved._integrator
    for name, solver in zip(("box", "nest"), live.solvers, strict=False):
        mass = solver.mass()
        given = mass["initial"] + mass["emitted"] + mass["entered"]
        share = np.cumsum(solver.smoke().sum((1, 2), dtype=float) * np.diff(solver.levels))
        tops = np.interp([0.5, 0.99], share / max(share[-1], 1e-30), solver.levels[1:])
        result |= {
            f"{name}_steps": float(solver.steps),
            f"{name}_half_of_the_smoke_below_m": tops[0],
            f"{name}_99_percent_below_m": tops[1],
            f"{name}_mass_error": abs((mass["airborne"] + mass["left"]) / given - 1.0),
        }
    result["solve_mb"] = memory.peak() / 2**20
    place = cache / f"smoke_{last:06d}.vdb"
    result["frame_s"], result["frame_processor_s"] = time_call(source.write, place, last)
    result["frame_mb"] = sum(path.stat().st_size for path in cache.glob("*.vdb")) / 1e6
    kept = [path.stat().st_size for path in cache.glob("*/moment_*.npz")]
    result["moments_mb_per_frame"] = sum(kept) / 1e6 / last
    result["memory_mb"] = memory.peak() / 2**20
    return result


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--frames", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    firetwin_core.set_threads(options.threads)
    with tempfile.TemporaryDirectory() as cache:
        result = {
            key: float(value) for key, value in measure(options.scene, options.frames, Path(cache)).items()
        }
    if options.json:
        print(json.dumps(result))
        return
    for key, value in result.items():
        print(f"{key:34} {value:14.6g}")


if __name__ == "__main__":
    main()
