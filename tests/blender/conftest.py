"""Tests that need Blender and build scenes: none renders a picture or starts a process."""

import os
import subprocess
import sys

import bpy
import firetwin
import numpy as np
import pytest
from firetwin.auto_framing import chase, coarse_smoke, flank, overview
from firetwin.shot.terrain import apron
from firetwin.smoke import coarse
from near_fire import *  # noqa: F403
from panel_scene import panel_blend  # noqa: F401
from small_scene import *  # noqa: F403


@pytest.fixture(autouse=True)
def no_waiting_for_the_disk(monkeypatch):
    """No test cuts the power, so files need not be on the disk."""
    monkeypatch.setattr(os, "fsync", lambda descriptor: None)


@pytest.fixture
def registered(factory):
    """Blender's factory settings with the add-on registered."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    yield
    firetwin.unregister()


_aprons = {}


@pytest.fixture(autouse=True)
def shared_aprons(monkeypatch):
    """Shots of the same land share its apron, unless an elevation model has heights there."""
    extend = apron.extend

    def known_or_extended(fields, cell, half_width, seed, known=None):
        arrays = (np.ascontiguousarray(array).tobytes() for array in list(vars(fields).values())[:5])
        key = (*arrays, fields.elevation.shape, cell, half_width, seed)
        if known is not None:
            return extend(fields, cell, half_width, seed, known)
        if key not in _aprons:
            _aprons[key] = extend(fields, cell, half_width, seed)
        return _aprons[key]

    monkeypatch.setattr(apron, "extend", known_or_extended)


@pytest.fixture(autouse=True)
def few_candidates(monkeypatch):
    """Auto framing tries few cameras, without smoke, and previews are coarser: see tests/unit."""
    monkeypatch.setattr(coarse, "COLUMNS", (600, 1200))
    monkeypatch.setattr(overview, "_BEARINGS", overview._BEARINGS[::4])
    monkeypatch.setattr(overview, "_HEIGHTS", overview._HEIGHTS[:2])
    monkeypatch.setattr(chase, "_SIDES", chase._SIDES[:2])
    monkeypatch.setattr(chase, "_HEIGHTS", chase._HEIGHTS[:2])
    monkeypatch.setattr(flank, "_PLACES", 2)
    monkeypatch.setattr(coarse_smoke, "_draw", lambda shot, frames: {})


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
