"""Memory of a long film: what one frame has read does not stay for all."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from firetwin.jobs import worker_scene
from firetwin_core import volume

SIDE, FRAMES = 128, 24  # 8 MB each


def resident() -> int:
    """Bytes that this process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.fixture
def limit():
    """Other data of Blender is unchanged afterwards."""
    system = bpy.context.preferences.system
    before = system.memory_cache_limit
    yield
    system.memory_cache_limit = before


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="only Linux tells how much a process holds")
@pytest.mark.usefixtures("limit")
def test_smoke_of_frames_that_are_over_is_forgotten(tmp_path, monkeypatch):
    monkeypatch.setattr(worker_scene, "KEPT", 16)
    stage = worker_scene.empty()
    values = np.random.default_rng(1).random((SIDE, SIDE, SIDE), np.float32)
    for frame in range(1, FRAMES + 1):
        volume.write(tmp_path / f"smoke_{frame:06d}.vdb", {"density": values}, 10.0)
    data = bpy.data.volumes.new("smoke")
    data.filepath, data.is_sequence, data.frame_duration = str(tmp_path / "smoke_000001.vdb"), True, FRAMES
    stage.scene.collection.objects.link(bpy.data.objects.new("smoke", data))
    held = []
    for frame in range(1, FRAMES + 1):
        stage.scene.frame_set(frame)
        data.grids.load()
        assert [grid.load() for grid in data.grids] == [True]
        held.append(resident())
    assert held[-1] - held[2] < 0.5 * (FRAMES - 3) * values.nbytes
