"""Faults around an artist: Esc at any time, a lost run, a full disk, several scenes, libraries."""

import contextlib
import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import bpy
import firetwin
import panel_scene
import pytest
from firetwin.errors import InputError
from firetwin.jobs import build as build_job
from firetwin.jobs import render as render_job
from firetwin.jobs import worker
from firetwin.progress import no_message, silent
from firetwin.shot.sections import SmokeSettings
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.shot.source import ShotSource
from firetwin.smoke import bake
from firetwin.ui import queue
from panel_scene import state


@pytest.fixture(scope="module")
def blend(run_folder, tmp_path_factory):
    """A scene that the panel built, as a file, with a copy of the run that may vanish."""
    return panel_scene.build_with_run(run_folder, tmp_path_factory.mktemp("failures"))


@pytest.fixture
def panel(blend):
    """A built scene of the panel."""
    yield from panel_scene.opened(blend)


def message(operator, **options):
    """Return the message of an operator that fails."""
    with pytest.raises(RuntimeError) as refused:
        operator(**options)
    text = str(refused.value)
    assert "Traceback" not in text
    assert "Unexpected" not in text
    return text


@pytest.fixture
def tiny():
    """A disk of 1 MB that is full, and what fills it."""
    place = Path("/tmp") / f"firetwin-full-{os.getpid()}"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(place)]
    if not shutil.which("mount") or subprocess.run(command, capture_output=True).returncode:
        place.rmdir()
        pytest.skip("cannot mount a small disk here")
    filler = place / "filler"
    with contextlib.suppress(OSError), filler.open("wb", buffering=0) as full:
        while full.write(bytes(4096)):
            pass
    yield filler
    subprocess.run(["umount", str(place)], check=True)
    place.rmdir()


def test_a_full_disk_is_a_message_and_what_was_there_stays(panel, blend, run, tiny, tmp_path, monkeypatch):
    """At every writer: settings, the .blend file, smoke, pictures, a copy for the queue."""
    place = tiny.parent
    before = state()
    assert "the disk is full" in message(bpy.ops.firetwin.export, filepath=str(place / "out.toml"))
    monkeypatch.setattr("tempfile.tempdir", str(place))
    panel.output = str(tmp_path)
    assert "cannot be copied" in message(bpy.ops.firetwin.render_background)
    monkeypatch.undo()
    assert not queue.items
    with pytest.raises(InputError, match="the disk is full"):
        build_job.save(place / "scene.blend", print)
    panel.output = str(blend.parent / "out")
    assert state() == before
    whole = scene_file.read(blend.with_suffix(".toml"))
    smoky = Shot(
        replace(whole, cache=place / "cache", smoke=SmokeSettings(method="preview", spin_up=60.0)), run
    )
    with pytest.raises(InputError, match="the disk is full"):
        bake.bake(smoky, frames=[1])
    firetwin.unregister()
    monkeypatch.setattr(worker, "run", here)
    asked = render_job.RenderRequest(place / "film", "1", passes="rgb", resume=True)
    choice = ShotSource(str(blend.with_suffix(".toml")))
    with pytest.raises(InputError, match="the disk is full"):
        render_job.run(choice, asked)
    assert not [path for path in place.rglob("*") if path.suffix in (".vdb", ".png", ".blend", ".toml")]
    tiny.unlink()
    assert render_job.run(choice, asked).pictures == 1
    assert (place / "film/drone/rgb/drone_rgb_000001.png").is_file()
    firetwin.register()


def here(work, progress=silent, tell=no_message, **_):
    """Replacement of a separate process."""
    return work(progress=progress, tell=tell)
