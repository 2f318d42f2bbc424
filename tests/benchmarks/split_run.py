"""Cost of a frame of the example when each cell of the run is split into 4 x 4.

    python tests/benchmarks/split_run.py SAMPLE --work DIR [--frame 20] [--split 4]

SAMPLE is the run of `firetwin sample --format npy`. Two runs are written to DIR from some of its minutes:
`run1` with its cells, and `run4` with each cell split into 4 x 4. Then, for both in turns, with
examples/king_fire.toml: the flow is solved and the frame's smoke baked, the scene is built, and the drone's
frame is rendered in all passes. Prints wall-clock seconds, CPU seconds and the peak memory of the process.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time
from pathlib import Path

from scale import cut

MINUTES = slice(960, 1150)
EXAMPLE = Path(__file__).parents[2] / "examples/king_fire.toml"


def scene(run: Path, frame: int) -> Path:
    """Write the example with this run, for one frame of the drone."""
    text = EXAMPLE.read_text(encoding="utf-8")
    text = re.sub(r'(?m)^run = "[^"]*"', f'run = "{run.as_posix()}"', text)
    text = re.sub(r'(?m)^cache = "[^"]*"', f'cache = "{run.name}-cache"', text)
    first, drone, *_ = re.split(r"(?m)^\[\[cameras\]\].*\n", text)
    drone = re.sub(r'(?m)^frames = "[^"]*"', f'frames = "{frame}"', drone)
    path = run.parent / f"{run.name}.toml"
    path.write_text(f"{first}[[cameras]]\n{drone}", encoding="utf-8")
    return path


def step(*given: object) -> tuple[float, float, float]:
    """Run a firetwin command; return wall-clock seconds, CPU seconds and peak memory, MB."""
    begun = time.perf_counter()
    with subprocess.Popen([sys.executable, "-m", "firetwin", *map(str, given)]) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(process.returncode)
    return time.perf_counter() - begun, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main() -> None:
    """Make the runs, then measure each step of both."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("sample", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--frame", type=int, default=20)
    parser.add_argument("--split", type=int, default=4)
    given = parser.parse_args()
    work = given.work.resolve()
    scenes = {}
    for split in (1, given.split):
        run = work / f"run{split}"
        if not run.exists():
            cut(given.sample, run, MINUTES, split, series=True)
        scenes[split] = scene(run, given.frame)
    steps = {
        "bake": lambda path: step("bake", path, "--volumes"),
        "build": lambda path: step("build", path, "-o", path.with_suffix(".blend")),
        "render": lambda path: step("render", path, "--out", path.with_suffix("")),
    }
    for name, run in steps.items():
        found = {split: run(path) for split, path in scenes.items()}
        for split, (wall, cpu, most) in found.items():
            print(f"{name:8}{split} x {split}{wall:8.1f} s{cpu:8.1f} cpu-s{most:8.0f} MB", flush=True)


if __name__ == "__main__":
    main()
