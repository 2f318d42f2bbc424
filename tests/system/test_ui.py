"""The panel: rejected input and its reasons, operators, stopped work, and its remains."""

import time
from types import SimpleNamespace

import bpy
import pytest
from firetwin.jobs.worker import StoppedError
from firetwin.ui import (
    job,
    render,
    working,
)


@pytest.fixture
def settings(panel):
    """The panel of a new file, as Blender starts with."""
    return panel


def test_render_makes_what_the_command_line_makes(settings, scene_file, tmp_path):
    settings.scene_file, settings.output = str(scene_file), str(tmp_path / "out")
    settings.which, settings.frame_list, settings.render.passes = "list", "2", {"rgb"}
    assert bpy.ops.firetwin.render() == {"FINISHED"}
    files = sorted(path.name for path in (tmp_path / "out").rglob("*") if path.is_file())
    assert [name for name in files if name.startswith("drone")] == [
        "drone_rgb_000002.exr",
        "drone_rgb_000002.png",
    ]
    assert "manifest.json" in files
    told = [each.text for each in working.last_messages(render.FIRETWIN_OT_render)]
    assert "rendering 1 picture of drone" in told
    assert any(text.startswith("Cycles renders on the processor") for text in told)
    assert told[-1] == f"Rendered 1 picture to {tmp_path / 'out'}"
    settings.frame_list = "2,9"
    with pytest.raises(RuntimeError, match=r'Frames: "9" is outside of 1-3'):
        bpy.ops.firetwin.render()


def test_a_render_is_stopped_in_the_middle_and_leaves_nothing(settings, scene_file, tmp_path):
    settings.scene_file, settings.output = str(scene_file), str(tmp_path / "out")
    settings.which = "all"
    operator = SimpleNamespace()
    work = job.Job("Render", render.FIRETWIN_OT_render.steps(operator, bpy.context))
    while not work.what.startswith("building the scene"):  # the worker is at work
        assert not work.advance()
        time.sleep(0.02)
    work.stop.now()
    with pytest.raises(StoppedError):
        work.run()
    assert not list(tmp_path.rglob(".part-*"))
    assert not list(tmp_path.rglob("*.png"))
