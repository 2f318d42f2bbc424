"""Cameras go to another program and come back, in separate processes."""

import struct
import subprocess
import sys
from functools import partial

import bpy
import numpy as np
import pytest
from firetwin.camera_import import alembic, foreign, usd
from firetwin.errors import InputError
from firetwin.progress import silent
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource

FRAME = 1.0 / 24.0


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


def write_times(path):
    """Write an Alembic file of 2 kB that states 2^31 - 1 times, 17 GB."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    for frame in (1, 2):
        camera.location.x = frame
        camera.keyframe_insert("location", frame=frame)
    bpy.ops.wm.alembic_export(filepath=str(path), start=1, end=2, as_background_job=False)
    data = bytearray(path.read_bytes())
    count = data.index(struct.pack("<d", FRAME)) + 8  # time per cycle, number of times, times
    assert data[count : count + 12] == struct.pack("<Id", 1, FRAME)
    data[count : count + 4] = struct.pack("<I", 2**31 - 1)
    path.write_bytes(data)


def write_prims(path):
    """Write a stage of 3 kB with 10^9 prims: ten in one another, nine times."""
    children = [
        "".join(f'def "c{child}" (references = </p{level + 1}>) {{}}\n' for child in range(10))
        for level in range(9)
    ]
    prims = "".join(f'def "p{level}" {{\n{inner}}}\n' for level, inner in enumerate(children))
    path.write_text(f'#usda 1.0\n(metersPerUnit = 1)\n{prims}def "p9" {{}}\n')


@pytest.mark.skipif(sys.platform != "linux", reason="limits the memory")
@pytest.mark.parametrize(
    ("name", "write", "read", "words"),
    [
        ("a.abc", write_times, partial(alembic.read, rate=(24, 1)), "is empty or not an Alembic file"),
        ("a.usda", write_prims, usd.read, "is damaged, or needs more than 0.3 GB of memory or 120 s to read"),
    ],
)
def test_a_small_file_that_grows_is_refused(name, write, read, words, tmp_path, monkeypatch):
    write(tmp_path / name)
    assert (tmp_path / name).stat().st_size < 4000
    monkeypatch.setattr(foreign, "CAMERA_MEMORY", 1 << 28)
    with pytest.raises(InputError, match=f"{name}: {words}"):
        read(tmp_path / name, progress=silent)
