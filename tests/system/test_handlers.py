"""No function of Firetwin is left in `bpy.app.handlers` at the end of a process; Python would hang there."""

import json
import os
import subprocess
import sys
import textwrap

import pytest
from scene_text import BARE, NO_SMOKE, TINY

NOTE = """\
import atexit, json, os, sys

def note():
    if "bpy" in sys.modules:
        lists = sys.modules["bpy"].app.handlers
        left = [
            f"{name}: {function.__module__}.{function.__qualname__}"
            for name in dir(lists)
            if isinstance(found := getattr(lists, name), list)
            for function in found
            if function.__module__.startswith("firetwin")
        ]
        with open(os.environ["HANDLERS_NOTES"], "a") as file:
            print(json.dumps(left), file=file)

def leave(status, leave=os._exit):
    note()
    leave(status)

atexit.register(note)  # first, so that it runs last
os._exit = leave  # how workers end
"""
"""A `sitecustomize`: at its end, each process with Blender notes the handlers of Firetwin that are left."""

SCENE = (
    'run = "{run}"\n[time]\nstart = 2014-09-17T21:30:00Z\nframes = 1\n'
    + NO_SMOKE + BARE + "trees = false\n[fire]\nfirebrands = 0\n" + TINY
    + 'passes = ["depth"]\n[[cameras]]\nname = "drone"\n'
    'keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]\n'
)  # fmt: skip


@pytest.fixture
def ended(tmp_path):
    """Run a Python process to its end: (exit status, handlers left in each process that used Blender)."""
    (tmp_path / "sitecustomize.py").write_text(NOTE)
    notes = tmp_path / "notes.jsonl"
    paths = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH")]))
    environment = os.environ | {"PYTHONPATH": paths, "HANDLERS_NOTES": str(notes)}

    def run(*arguments):
        done = subprocess.run([sys.executable, *arguments], env=environment, capture_output=True, text=True)
        found = [json.loads(line) for line in notes.read_text().splitlines()]
        notes.unlink()
        return done.returncode, found

    return run


def test_commands_leave_no_handler(ended, run_folder, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(run=run_folder))
    built = ["build", str(scene), "-o", str(tmp_path / "scene.blend")]
    rendered = ["render", str(scene), "--out", str(tmp_path / "film")]
    for command in (built, rendered):
        status, left = ended("-m", "firetwin", *command)
        assert status == 0
        assert left  # the worker process
        assert not any(left)
    assert (tmp_path / "scene.blend").exists()
    assert len(list(tmp_path.glob("film/drone/depth/*.exr"))) == 1


@pytest.mark.parametrize("end", ["", "firetwin.unregister()"])
def test_a_registered_add_on_leaves_no_handler_and_its_process_ends(ended, end):
    """Without a call of `unregister` too: left handlers and classes ended it by a crash, or never."""
    script = textwrap.dedent(f"""
        import bpy, firetwin
        firetwin.register()
        assert firetwin.ui.former_names.migrate in bpy.app.handlers.load_post
        {end}
    """)
    assert ended("-c", script) == (0, [[]])
