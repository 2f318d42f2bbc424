"""Tests that need Blender and build scenes: none renders a picture or starts a process."""

import subprocess
import sys

import bpy
import firetwin
import pytest
from few_cameras import *  # noqa: F403
from near_fire import *  # noqa: F403
from panel_scene import panel_blend  # noqa: F401
from quick_work import *  # noqa: F403
from small_scene import *  # noqa: F403


@pytest.fixture
def registered(factory):
    """Blender's factory settings with the add-on registered."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    yield
    firetwin.unregister()


@pytest.fixture(autouse=True)
def few_candidates(few_cameras):
    """Automatic framing tries few cameras everywhere: see tests/unit."""


@pytest.fixture(autouse=True)
def no_picture_and_no_process(monkeypatch):
    """Tests that render belong in tests/render, tests that start a process in tests/system."""
    rendered = []

    @bpy.app.handlers.persistent
    def note(*_):
        rendered.append(True)

    bpy.app.handlers.render_init.append(note)
    start = subprocess.Popen.__init__

    def refuse(self, command, *arguments, **options):
        if sys.executable in command:
            pytest.fail("a test that starts a process belongs into tests/system")
        start(self, command, *arguments, **options)  # of a library

    monkeypatch.setattr(subprocess.Popen, "__init__", refuse)
    yield
    if note in bpy.app.handlers.render_init:
        bpy.app.handlers.render_init.remove(note)
    if rendered:
        pytest.fail("a test that renders belongs into tests/render")
