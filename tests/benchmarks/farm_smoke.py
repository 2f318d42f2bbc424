"""Whether the smoke of a farm's frames is better painted by render tasks, or by tasks of its own before.

    python tests/benchmarks/farm_smoke.py SAMPLE --work DIR [--runs 3] [--frames 3]

SAMPLE is the run of `firetwin sample --format npy`. Of the first frames of the example's drone, whose flow is
solved before: seconds to paint a frame's smoke in memory, and to write it as VDB; seconds of a frame in a
render task that paints it (integrated, and drawn by Cycles as a volume), and in one that finds its VDB. Tasks
are those of farm_chunk.py. Rows of a run follow one another; medians of all runs.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import farm_chunk

SCENES = {"integrated": {}, "as a volume": {"draw": '"volume"'}}


def painted(scene: Path, cache: Path, frames: int) -> dict[str, float]:
    """Median seconds, and seconds of the processor, of a frame's smoke in memory and as files; and bytes."""
    from firetwin.shot.comparison import for_view
    from firetwin.shot.source import ShotSource
    from firetwin.smoke import sources

    source = sources.select(for_view(ShotSource(scene=str(scene), cache=str(cache)).shot(), "drone"))
    found: dict[str, list[float]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as place:
        for frame in range(1, frames + 2):  # the first one prepares what all share
            for name in ("paint", "write"):
                clock, processor = time.perf_counter(), time.process_time()
                if name == "paint":
                    source.bricks(frame)
                else:
                    source.write(Path(place) / f"smoke_{frame:06d}.vdb", frame)
                if frame > 1:
                    found[name].append(time.perf_counter() - clock)
                    found[f"{name}, cpu"].append(time.process_time() - processor)
        size = sum(path.stat().st_size for path in Path(place).rglob("*.vdb")) / (frames + 1)
    return {name: statistics.median(values) for name, values in found.items()} | {"MB": size / 1e6}


def main() -> None:
    """Measure in turns; print medians."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("sample", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--paint", help=argparse.SUPPRESS)
    given = parser.parse_args()
    work = given.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    cache = work / "cache"
    cache.mkdir(exist_ok=True)
    if given.paint:
        print(json.dumps(painted(Path(given.paint), cache, given.frames)))
        return
    scenes = {
        name: farm_chunk.scene(work / f"{name.split()[-1]}.toml", given.sample.resolve(), changes)
        for name, changes in SCENES.items()
    }
    farm_chunk.solve(scenes["integrated"], cache, given.frames + 1)
    runs: dict[str, list[float]] = defaultdict(list)
    for _ in range(given.runs):
        paint = [*sys.argv, "--paint", str(scenes["integrated"])]
        said = subprocess.run([sys.executable, *paint], check=True, stdout=subprocess.PIPE, text=True).stdout
        for name, value in json.loads(said.splitlines()[-1]).items():
            runs[name].append(value)
        for path in cache.rglob("smoke_*.vdb"):
            path.unlink()
        for name, what in (
            ("integrated", "integrated"),
            ("as a volume", "painted"),
            ("as a volume", "found"),
        ):
            row = farm_chunk.task(scenes[name], work / "out", cache, given.frames)
            label = name if name == what else f"{name}, {what}"
            runs[f"frame {label}"].append(row["frame"])
    for name, values in runs.items():
        print(f"{name:32}{statistics.median(values):10.2f}")


if __name__ == "__main__":
    main()
