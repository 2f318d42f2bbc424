"""Tests that need Blender and build scenes: none renders a picture or starts a process."""

import os
import subprocess
import sys

import bpy
import pytest
from near_fire import *  # noqa: F403
from small_scene import *  # noqa: F403


@pytest.fixture(autouse=True)
def no_waiting_for_the_disk(monkeypatch):
    """No test cuts the power, so files need not be on the disk."""
    monkeypatch.setattr(os, "fsync", lambda descriptor: None)


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
