"""A small film of two cameras for tests of farms, and what there is of one that was made."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from scene_text import NO_PLANTS, TINY

SCENE = (
    """\
run = "{run}"
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = {frames}
"""
    + NO_PLANTS
    + """\
[smoke]
enabled = {smoke}
method = "puffs"
voxel_size = 120.0
"""
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


def scene(path: Path, run: Path, frames: int = 4, smoke: str = "true") -> Path:
    """Write the scene file; the second camera films a frame less than the first."""
    path.write_text(SCENE.format(run=run, frames=frames, others=frames - 1, smoke=smoke))
    return path


def firetwin(*arguments: object, environment: dict[str, str] | None = None, status: int = 0) -> str:
    """Run the command; what it prints."""
    command = [sys.executable, "-m", "firetwin", *map(str, arguments)]
    done = subprocess.run(
        command, env=environment or dict(os.environ), capture_output=True, text=True, timeout=900
    )
    assert done.returncode == status, f"{done.returncode}: {done.stdout}{done.stderr}"
    return done.stdout


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


def copied(out: Path, to: Path) -> Path:
    """The film and its job, as another test may change it."""
    shutil.copytree(out, to)
    return to
