"""Renders that share a folder: kills, and pictures that are cut off."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from firetwin.render.store import Store
from firetwin_core import sensor
from scene_text import NO_PLANTS, PREVIEW, TINY

FRAMES = 4
KILLS = int(os.environ.get("FIRETWIN_KILLS", "2"))
SEED = int(os.environ.get("FIRETWIN_SEED", "1"))
SCENE = (
    """\
run = "{run}"
cache = "{cache}"
[time]
frames = {frames}
"""
    + NO_PLANTS
    + PREVIEW
    + TINY
    + """\
passes = ["rgb", "depth", "normal", "thermal"]
[[cameras]]
name = "drone"
keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]
[[cameras]]
name = "other"
frames = "1-2"
keys = [{{latitude = 38.83, longitude = -120.55, height = 500, target = "fire"}}]
"""
)


@pytest.fixture
def start(run_folder, tmp_path):
    """Start a render: start(out, before=..., frames=...) -> process."""

    def begin(out, before=None, frames=3):
        scene = tmp_path / f"scene-{frames}.toml"
        scene.write_text(SCENE.format(run=run_folder, cache=tmp_path / "cache", smoke="false", frames=frames))
        environment = dict(os.environ)
        if before:
            environment["PYTHONPATH"] = os.pathsep.join([str(before), environment.get("PYTHONPATH", "")])
        return subprocess.Popen(
            [sys.executable, "-m", "firetwin", "render", scene, "--out", out, "--resume"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env=environment,
        )

    return begin


@pytest.fixture
def render(start):
    """Run a render to its end and return its output."""

    def run(*arguments, **options):
        process = start(*arguments, **options)
        said = process.communicate(timeout=600)[1]
        assert process.returncode == 0, said
        return said

    return run


def _contents(out):
    """Bytes of every file but films and the store, whose pages depend on the order of entries.

    An encoder may write the same pictures in other bytes; the manifest tells what films are made from, and
    how long frames took.
    """
    manifest = json.loads((out / "manifest.json").read_text())
    manifest.pop("processor_seconds", None)
    for path, entry in manifest["files"].items():
        if path.endswith(".mp4"):
            del entry["bytes"], entry["sha256"]
    found = {
        str(path.relative_to(out)): path.read_bytes()
        for path in out.rglob("*")
        if path.is_file() and path.name != "store.sqlite" and path.suffix != ".mp4"
    }
    return found | {"manifest.json": manifest}


def _films(out):
    """Frames of every film, (n, height, width, 3) of 0..255."""
    frames = {}
    for path in sorted(out.rglob("*.mp4")):
        command = ["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        raw = subprocess.run(command, check=True, capture_output=True).stdout
        frames[path.name] = np.frombuffer(raw, np.uint8).reshape(-1, 36, 64, 3).astype(float)
    return frames


def test_two_renders_killed_at_random_make_the_files_of_one(start, render, tmp_path):
    chance = random.Random(SEED)
    undisturbed, shared = tmp_path / "one", tmp_path / "two"
    begun = time.monotonic()
    render(undisturbed, frames=FRAMES)
    alone = time.monotonic() - begun
    running = [start(shared, frames=FRAMES), start(shared, frames=FRAMES)]
    for _ in range(KILLS):
        time.sleep(chance.uniform(0.2, 1.2) * alone)
        which = chance.randrange(2)
        with_child = chance.random() < 0.5  # or the parent alone, or both
        if running[which].poll() is None:
            (os.killpg if with_child else os.kill)(running[which].pid, signal.SIGKILL)
        running[which].communicate()
        running[which] = start(shared, frames=FRAMES)
    for process in running:
        said = process.communicate(timeout=600)[1]
        assert process.returncode == 0, said
    wanted, found = _contents(undisturbed), _contents(shared)
    assert set(found) == set(wanted)
    assert [name for name in wanted if found[name] != wanted[name]] == []
    films, others = _films(undisturbed), _films(shared)
    assert {name: len(film) for name, film in films.items()} == {
        name: len(film) for name, film in others.items()
    }
    apart = {name: np.abs(film - others[name]).mean(axis=(1, 2, 3)).max() for name, film in films.items()}
    assert max(apart.values()) < 1.5, apart  # neighbouring pictures differ by 1.7 or more


def test_a_cut_off_picture_is_never_entered(start, tmp_path):
    out, before = tmp_path / "out", tmp_path / "before"
    before.mkdir()
    (before / "sitecustomize.py").write_text(_CUT)
    process = start(out, before)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == 1
    assert "drone_depth_000001.exr" in said.splitlines()[-1]
    assert not list(out.glob("drone/*/*_000001.*"))
    with Store(out) as store:
        assert store.names() == []
    process = start(out)
    assert process.wait(timeout=300) == 0
    for path in out.glob("*/*/*.exr"):
        assert sensor.read_image(path).shape[:2] == (36, 64)


_CUT = """\
import firetwin_core.sensor, pathlib
read = firetwin_core.sensor.read_image
def cut(path):  # as a full disk would
    path = pathlib.Path(path)
    if "depth" in path.name:
        path.write_bytes(path.read_bytes()[:-40])
    return read(path)
firetwin_core.sensor.read_image = cut
"""
