"""A small film of two cameras for tests of farms, and what there is of one that was made."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from scene_text import NO_PLANTS, PREVIEW, TINY

SCENE = (
    """\
run = '{run}'
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = {frames}
shutter = 0.0
"""
    + NO_PLANTS
    + PREVIEW
    + TINY
    + """\
passes = ["rgb", "depth"]
chunk = 2
[[cameras]]
name = "drone"
keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]
[[cameras]]
name = "other"
frames = "1-{others}"
keys = [{{latitude = 38.83, longitude = -120.55, height = 500, target = "fire"}}]
"""
)


def scene(path: Path, run: Path, frames: int = 4, smoke: str = "false") -> Path:
    """Write the scene file; the second camera films a frame less than the first."""
    path.write_text(SCENE.format(run=run, frames=frames, others=frames - 1, smoke=smoke))
    return path


FLOW = """\
[smoke]
method = "flow"
cell_budget = 0.1
spin_up = 120.0
voxel_size = 150.0
"""
"""Smoke of a flow that is solved in seconds."""


def flow_scene(path: Path, run: Path, frames: int = 24) -> Path:
    """Write the scene file of six minutes of the fire, with smoke of a flow, in parts of 12 frames."""
    text = scene(path, run, frames).read_text()
    for old, new in (
        (PREVIEW.format(smoke="false"), FLOW),
        ("end = 2014-09-17T22:00:00Z", "end = 2014-09-17T21:06:00Z"),
        ("chunk = 2\n", "chunk = 12\n"),
    ):
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def start(*arguments: object, environment: dict[str, str] | None = None) -> subprocess.Popen[str]:
    """Start the command."""
    return subprocess.Popen(
        [sys.executable, "-m", "firetwin", *map(str, arguments)],
        env=environment or dict(os.environ),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def firetwin(*arguments: object, environment: dict[str, str] | None = None, status: int = 0) -> str:
    """Run the command and return its output."""
    process = start(*arguments, environment=environment)
    said, errors = process.communicate(timeout=900)
    assert process.returncode == status, f"{process.returncode}: {said}{errors}"
    return said


def until(there: Callable[[], object], seconds: float = 300.0) -> None:
    """Wait until something is there."""
    end = time.monotonic() + seconds
    while not there():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.05)


def pictures(out: Path) -> dict[str, str]:
    """SHA-256 of every file in the manifest."""
    files = json.loads((out / "manifest.json").read_text())["files"]
    return {path: entry["sha256"] for path, entry in files.items()}


def rendered(out: Path) -> list[str]:
    """Every file that an attempt at a task finished, as often as it was finished."""
    found = []
    for path in sorted((out / "farm" / "entries").glob("*.jsonl")):
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        found += [line[0] for line in lines if isinstance(line, list)]
    return found


def ended(out: Path) -> list[int | None]:
    """Exit status of every attempt at a task; None of those that were killed."""
    found = []
    for path in sorted((out / "farm" / "entries").glob("*.jsonl")):
        lines = path.read_text().splitlines()  # none while the file is being started
        last = json.loads(lines[-1]) if lines else None
        found.append(last.get("ended") if isinstance(last, dict) else None)
    return found


def without(out: Path, to: Path, *numbers: int) -> Path:
    """A copy of a film in which tasks have never run: their pictures and entries are not there."""
    shutil.copytree(out, to)
    for number in numbers:
        for path in (to / "farm" / "entries").glob(f"{number:05d}-*.jsonl"):
            for line in map(json.loads, path.read_text().splitlines()):
                if isinstance(line, list):
                    (to / line[0]).unlink()
            path.unlink()
    return to
