"""Overhead of a farm task against frames per task.

    python tests/benchmarks/farm_chunk.py SAMPLE --work DIR [--runs 3] [--frames 5] [--plot FILE.svg]

SAMPLE is the run of `firetwin sample --format npy`. Tasks of the first frames of the example's drone run as
farm engines run them, the cases in turns: preview and flow at 160 x 90 pixels, flow at the example's size.
The flow is solved before, as by a bake task. Two more cases render a film of 960 frames in 16 hours, built in
parts of 24 and of 480 frames. Times are wall-clock seconds, medians of all runs.

`start`: until the command is ready. `resolve`: until the missing pictures are known. `build`: until the first
frame begins, in a separate process. `frame`: each frame after the first. `overhead`: task time minus frame
times. The last column is the number of frames per task that keeps the overhead below a tenth.
"""

from __future__ import annotations

import argparse
import functools
import itertools
import json
import re
import shutil
import statistics
import subprocess
import sys
import threading
import time
from collections import defaultdict
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples/king_fire.toml"
SMALL = {"resolution": "[160, 90]", "samples": "1"}
CASES = {
    "preview, 160 x 90": {"method": '"preview"', **SMALL},
    "flow, 160 x 90": SMALL,
    "flow, 640 x 360": {},
}
LONG = {
    "start": "2014-09-17T08:00:00-07:00",
    "end": "2014-09-18T00:00:00-07:00",
    "frames": "960",
    "method": '"preview"',
    **SMALL,
}
PARTS = {f"{chunk} frames built": {**LONG, "chunk": str(chunk)} for chunk in (24, 480)}
MOST = 0.1  # largest overhead, fraction of a task's time
SIZES = (1, 2, 4, 8, 15, 30, 60, 120, 240)
PHASES = ("start", "resolve", "build", "frame", "overhead")


def scene(path: Path, run: Path, changes: dict[str, str]) -> Path:
    """Write the example with its drone only, and with other values of some keys."""
    text = EXAMPLE.read_text(encoding="utf-8")
    head, drone, *_ = re.split(r"(?m)^\[\[cameras\]\].*\n", text)
    for name, value in {"run": json.dumps(run.as_posix()), **changes}.items():
        head, found = re.subn(rf"(?m)^{name} = [^#\n]*?( *#.*)?$", f"{name} = {value}", head, count=1)
        assert found, name
    path.write_text(f"{head}[[cameras]]\n{drone}", encoding="utf-8")
    return path


def solve(path: Path, cache: Path, frames: int) -> None:
    """Solve the flow of the frames that the tasks render."""
    from firetwin.jobs import solve
    from firetwin.progress import Reporter, say
    from firetwin.shot.source import ShotSource

    choice = ShotSource(scene=str(path), cache=str(cache))
    solve.in_process(choice, "drone", list(range(1, frames + 1)), Reporter(), say)


def task(path: Path, out: Path, cache: Path, frames: int) -> dict[str, float]:
    """Run a task that renders the first frames, and return the seconds of its phases."""
    shutil.rmtree(out, ignore_errors=True)
    firetwin = [sys.executable, "-m", "firetwin", "farm"]
    plan = [*firetwin, str(path), "--engine", "openjd", "--out", str(out), "--chunk", str(frames)]
    subprocess.run(plan, check=True, capture_output=True)
    first = next(
        number
        for number, each in enumerate(json.loads((out / "farm/job.json").read_text())["tasks"], start=1)
        if each["stage"] == "render"
    )
    (out / "farm/cache").symlink_to(cache)
    began = time.perf_counter()
    with subprocess.Popen(
        [*firetwin, "task", str(out), str(first)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        lines: list[tuple[float, str]] = []
        read = [
            threading.Thread(target=_listen, args=(pipe, lines)) for pipe in (process.stdout, process.stderr)
        ]
        for each in read:
            each.start()
        for each in read:
            each.join()
    end = time.perf_counter()
    if process.returncode:
        raise SystemExit("".join(line for _, line in lines))
    lines.sort()
    at = functools.partial(_when, lines)
    done = [when for when, line in lines if line.startswith("openjd_progress")][: frames + 1]
    spans = [after - before for before, after in itertools.pairwise(done[1:])]
    frame = statistics.median(spans) if spans else 0.0
    return {
        "start": at("openjd_status") - began,
        "resolve": at("firetwin: rendering") - at("openjd_status"),
        "build": done[0] - at("firetwin: rendering"),
        "frame": frame,
        "overhead": end - began - frames * frame,
    }


def _listen(pipe: object, lines: list[tuple[float, str]]) -> None:
    for line in pipe:  # type: ignore[attr-defined]
        lines.append((time.perf_counter(), line))


def _when(lines: list[tuple[float, str]], begin: str) -> float:
    return next(when for when, line in lines if line.startswith(begin))


def enough(overhead: float, frame: float) -> int:
    """Return the least number of frames per task with an overhead below `MOST`."""
    return int(overhead * (1.0 - MOST) / (MOST * frame)) + 1


def plot(rows: dict[str, dict[str, float]], path: Path, chosen: int) -> None:
    """Draw the overhead fraction against frames per task."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "firetwin"
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(6.0, 3.6), layout="constrained")
    for (name, row), colour in zip(rows.items(), ("#35b779", "#31688e", "#d1410c"), strict=False):
        shares = [100.0 * share(row, size) for size in SIZES]
        axis.plot(SIZES, shares, "o-", color=colour, markersize=4, label=name)
    axis.axhline(100.0 * MOST, color="0.5", linewidth=0.8)
    axis.axvline(chosen, color="0.5", linewidth=0.8, linestyle=":")
    axis.set(xscale="log", ylim=(0, 100), xlabel="frames per task", ylabel="overhead, % of a task's time")
    axis.set_xticks(SIZES, map(str, SIZES))
    axis.minorticks_off()
    axis.grid(alpha=0.3, linewidth=0.5)
    axis.legend(fontsize=8)
    figure.savefig(path, metadata={"Date": None})


def share(row: dict[str, float], size: int) -> float:
    """Return the overhead as a fraction of a task's time."""
    return row["overhead"] / (row["overhead"] + size * row["frame"])


def main() -> None:
    """Run tasks of all cases in turns; print medians and the curve."""
    from firetwin.farm.plan import CHUNK

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("sample", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--plot", type=Path, help="SVG of the curve")
    given = parser.parse_args()
    work, cases = given.work.resolve(), CASES | PARTS
    work.mkdir(parents=True, exist_ok=True)
    cache = work / "cache"
    cache.mkdir(exist_ok=True)
    scenes = {
        name: scene(work / f"case{k}.toml", given.sample.resolve(), changes)
        for k, (name, changes) in enumerate(cases.items())
    }
    solve(scenes["flow, 160 x 90"], cache, given.frames)
    runs: dict[str, list[dict[str, float]]] = defaultdict(list)
    for _ in range(given.runs):
        for name, path in scenes.items():
            runs[name].append(task(path, work / "out", cache, given.frames))
    measured = {
        name: {phase: statistics.median(each[phase] for each in rows) for phase in PHASES}
        for name, rows in runs.items()
    }
    print(f"{'':22}" + "".join(f"{phase:>10}" for phase in PHASES) + "    frames per task")
    for name, row in measured.items():
        seconds = "".join(f"{row[phase]:10.2f}" for phase in PHASES)
        print(f"{name:22}{seconds}{enough(row['overhead'], row['frame']):19}")
    print(f"{'frames per task':22}" + "".join(f"{size:7}" for size in SIZES))
    for name, row in measured.items():
        print(f"{name:22}" + "".join(f"{100.0 * share(row, size):6.1f}%" for size in SIZES))
    if given.plot:
        plot({name: measured[name] for name in CASES}, given.plot, CHUNK)


if __name__ == "__main__":
    main()
