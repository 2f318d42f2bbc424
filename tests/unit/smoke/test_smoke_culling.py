"""Smoke that no camera sees is left out, and the rest stays the same."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import lod, volume
from plumes import read, smoke

NORTH = np.column_stack([[1, 0, 0], [0, 0, 1], [0, -1, 0]]).astype(float)  # looks north


def test_what_is_written_stays_the_same(tmp_path):
    puffs = smoke(3000.0, smallest=120.0)
    whole = volume.write_smoke(tmp_path / "whole.vdb", puffs, 120.0)
    view = lod.ViewSet([(4000.0, -9000.0, 1500.0)], NORTH, np.tan((0.15, 0.1)), sun=(0.0, 0.6, 0.8))
    part = volume.write_smoke(tmp_path / "part.vdb", puffs, 120.0, views=view)
    assert 0.05 * whole.active_voxels < part.active_voxels < 0.8 * whole.active_voxels
    assert part.mass + part.culled_mass == pytest.approx(whole.mass, rel=1e-9)
    assert part.culled_mass > 0.1 * whole.mass
    assert part.bytes < whole.bytes
    everything, some = read(tmp_path / "whole.vdb"), read(tmp_path / "part.vdb")
    for name, (values, low) in some.items():
        full, corner = everything[name]
        offset = low - corner
        same = full[tuple(slice(o, o + n) for o, n in zip(offset, values.shape, strict=True))]
        there = some["dilution"][0] > 0.0
        assert np.array_equal(values[there], same[there])


def test_only_the_wanted_grids_are_written(tmp_path):
    puffs = smoke(1500.0, smallest=150.0)
    lit = {"flame_position": [[1200.0, 0.0, 1020.0]], "flame_power": [1.0e9]}
    path = tmp_path / "smoke.vdb"
    frame = volume.write_smoke(path, puffs, 150.0, grids=["dilution", "glow"], **lit)
    assert set(read(path)) == {"dilution", "glow"}
    assert frame.voxels == 2 * frame.active_voxels
    volume.write_smoke(path, puffs, 150.0, grids=["dilution", "glow"])
    assert set(read(path)) == {"dilution"}
    with pytest.raises(ValueError, match="choose from density"):
        volume.write_smoke(path, puffs, 150.0, grids=["smoke"])


def test_any_number_of_threads_writes_the_same(tmp_path, all_threads):
    puffs = smoke(2500.0, smallest=120.0)
    found = []
    for number in (1, 2, 4):
        core.set_threads(number)
        frame = volume.write_smoke(tmp_path / "smoke.vdb", puffs, 120.0)
        found.append(((tmp_path / "smoke.vdb").read_bytes(), frame.mass))
    assert found[0] == found[1] == found[2]
