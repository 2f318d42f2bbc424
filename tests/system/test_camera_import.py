"""Cameras go to another program and come back, in separate processes."""

import subprocess
import sys

import numpy as np
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource


def firetwin(*words, status=0):
    command = [sys.executable, "-m", "firetwin", *map(str, words)]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == status, ended.stderr
    return ended


def test_a_camera_comes_back_by_alembic_and_is_named_in_the_scene(settings, tmp_path):
    settings.path.write_text(scene_file.text(settings))
    out = tmp_path / "out"
    firetwin("export", settings.path, "--to", "alembic", "--out", out, "--geoid", "-24.5")
    ended = firetwin("import", out / "cameras.abc", "--out", settings.path, "--name", "again")
    assert ended.stdout.split() == [str(settings.path)]
    one, two = ShotSource(str(settings.path)).shot().paths
    assert two.camera.name == "again"
    assert np.linalg.norm(one.position - two.position, axis=1).max() < 0.01


def test_a_file_that_is_no_stage_leaves_the_scene_as_it_was(settings, tmp_path):
    settings.path.write_text(scene_file.text(settings))
    before = settings.path.read_bytes()
    (tmp_path / "move.usdc").write_bytes(b"PXR-USDC\x00\x08" + b"\xff" * 500)
    ended = firetwin("import", tmp_path / "move.usdc", "--out", settings.path, status=1)
    assert "cannot be opened as a USD stage" in ended.stderr
    assert settings.path.read_bytes() == before
