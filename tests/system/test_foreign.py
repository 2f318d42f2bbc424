"""A fire model's own files are opened in Blender: a run is made of them, once, and opened."""

import os

import bpy
import numpy as np
import pytest
from firetwin.jobs import convert

SAID = {"start": "2020-07-01T20:00:00Z", "at": "39,-120"}


@pytest.fixture
def file(tmp_path):
    """Output of pyretechnics for a round fire; reading it needs only packages of Blender."""
    path = tmp_path / "fire.npz"
    minutes = np.hypot(*np.mgrid[-8:9, -8:9]) * 30.0 / 60.0
    np.savez(path, time_of_arrival=minutes, cell_width=30.0, cell_height=30.0)
    return path


def test_a_models_own_file_is_opened(panel, file, monkeypatch):
    assert bpy.ops.firetwin.open(filepath=str(file), **SAID) == {"FINISHED"}
    run = file.with_name("fire_run")
    assert (panel.run, panel.problem) == (str(run), "")
    assert panel.cameras.keys()
    assert "pyretechnics" in panel.facts
    monkeypatch.setattr(convert, "run", None)  # it is not made twice
    panel.run = ""
    directory, files = str(file.parent), [{"name": file.name}]
    assert bpy.ops.firetwin.open(directory=directory, files=files, filepath=directory, **SAID) == {"FINISHED"}
    assert panel.run == str(run)


def test_other_words_make_another_run(panel, file):
    for start, name in (("2020-07-01T20:00Z", "fire_run"), ("2020-07-02T20:00Z", "fire_run_2")):
        bpy.ops.firetwin.open(filepath=str(file), start=start)
        assert panel.run == str(file.with_name(name))


def test_what_is_missing_is_asked_for_in_the_panels_words(panel, file):
    with pytest.raises(RuntimeError, match=r"give it: Start \(next to the files in Open run\) 2014-09"):
        bpy.ops.firetwin.open(filepath=str(file))
    assert "has no start time" in panel.problem
    assert [each.name for each in file.parent.iterdir()] == [file.name]


def test_the_field_run_takes_a_models_folder_too(panel, file, monkeypatch, tmp_path):
    """And says how packages that are missing are had."""
    (tmp_path / "netCDF4.py").write_text("raise ImportError")
    (tmp_path / "model").mkdir()
    (tmp_path / "model" / "wrfout_d01").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(99))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    panel.run = str(tmp_path / "model")
    assert "needs the Python package netCDF4; install it with: " in panel.problem
    assert "-m pip install 'firetwin[models]'" in panel.problem
    assert not (tmp_path / "model_run").exists()
