"""Smoke of a farm's frames: painted by render tasks, or baked by separate tasks before.

    python tests/benchmarks/farm_smoke.py SAMPLE --work DIR [--runs 3] [--frames 3]

SAMPLE is the run of `firetwin sample --format npy`. The first frames of the example's drone are rendered,
with their flow solved before. Prints the seconds to paint a frame's smoke in memory and to write it as VDB,
and the seconds of a frame in a render task that paints it (integrated, and as a Cycles volume) and in a
render task that reads its VDB. Tasks run as in farm_chunk.py. Medians of all runs.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import farm_chunk
from firetwin.bench.timing import Stopwatch

SCENES = {"integrated": {}, "as a volume": {"draw": '"volume"'}}


def painted(scene: Path, cache: Path, frames: int) -> dict[str, float]:
    """Return median wall-clock and CPU seconds of a frame's smoke in memory and as a file, and its MB."""
    from firetwin.shot.comparison import for_view
    from firetwin.shot.source import ShotSource
    from firetwin.smoke import sources

    source = sources.select(for_view(ShotSource(scene=str(scene), cache=str(cache)).shot(), "drone"))
    seconds: dict[str, list[float]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as place:
        for frame in range(1, frames + 2):  # the first one prepares shared data
            for name in ("paint", "write"):
                watch = Stopwatch()
                if name == "paint":
                    source.bricks(frame)
                else:
                    source.write(Path(place) / f"smoke_{frame:06d}.vdb", frame)
                if frame > 1:
                    spent = watch.read()
                    seconds[name].append(spent.seconds)
                    seconds[f"{name}, cpu"].append(spent.processor)
        size = sum(path.stat().st_size for path in Path(place).rglob("*.vdb")) / (frames + 1)
    return {name: statistics.median(values) for name, values in seconds.items()} | {"MB": size / 1e6}


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
        text = subprocess.run([sys.executable, *paint], check=True, stdout=subprocess.PIPE, text=True).stdout
        for name, value in json.loads(text.splitlines()[-1]).items():
            runs[name].append(value)
        for path in cache.rglob("smoke_*.vdb"):
            path.unlink()
        for name, smoke in (
            ("integrated", "integrated"),
            ("as a volume", "painted"),
            ("as a volume", "found"),
        ):
            row = farm_chunk.task(scenes[name], work / "out", cache, given.frames)
            label = name if name == smoke else f"{name}, {smoke}"
            runs[f"frame {label}"].append(row["frame"])
    for name, values in runs.items():
        print(f"{name:32}{statistics.median(values):10.2f}")


if __name__ == "__main__":
    main()
