"""Smoke that no camera sees: what counts, what is left out, and that the rest stays the same."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import volume
from test_volume import read, smoke

NORTH = np.column_stack([[1, 0, 0], [0, 0, 1], [0, -1, 0]]).astype(float)  # looks north
FOV = (np.radians(60.0), np.radians(40.0))


def sight(place=(0.0, 0.0, 1000.0), sun=(0.0, 0.0, 0.0), floor=0.0):
    return volume.Sight([place], [NORTH], [FOV], sun, floor)


def test_what_is_before_the_camera_counts():
    view = sight()
    assert view.counts((0, 5000, 1000), 100)
    assert not view.counts((0, -5000, 1000), 100)
    assert not view.counts((5000, 5000, 1000), 100)
    assert view.counts((3100, 5000, 1000), 500)  # the edge is at 2887 m
    assert volume.Sight(np.empty((0, 3)), np.empty((0, 3, 3)), np.empty((0, 2))).counts((0, -5000, 0), 1)


@pytest.mark.parametrize(("height", "counts"), [(60.0, True), (0.5, False), (-20.0, False)])
def test_what_shadows_the_view_counts(height, counts):
    """Smoke beside the view, whose shadow falls 3 km further east into it."""
    up = np.radians(height)
    sun = (-np.cos(up), 0.0, np.sin(up))
    blocked = (-6000.0, 6000.0, 1000.0 + 6000.0 * np.tan(max(up, 0.0)))
    assert sight(sun=sun).counts(blocked, 100.0) == counts
    away = (np.cos(up), 0.0, np.sin(up))
    assert not sight(sun=away).counts(blocked, 100.0)


def test_shadows_end_on_the_ground():
    up = np.radians(45.0)
    sun = (-np.cos(up), 0.0, np.sin(up))
    beside = (-6000.0, 5000.0, 3500.0)  # its shadow is at x = -4000 at height 1500, at -2500 at 0
    assert sight(sun=sun).counts(beside, 100.0)
    assert not sight(sun=sun, floor=1500.0).counts(beside, 100.0)


def test_no_shadow_slips_through():
    """Whatever has a point up the sun's rays from a point in a narrow view counts; most else does not."""
    random = np.random.default_rng(5)
    fov = np.radians([1.5, 1.0])
    kept = 0
    for _ in range(3000):
        sun = random.normal(size=3)
        sun[2] = abs(sun[2]) + 0.05
        sun /= np.linalg.norm(sun)
        view = volume.Sight([(0.0, 0.0, 1000.0)], [NORTH], [fov], sun)
        depth = random.uniform(0.0, 20_000.0)
        east, up = depth * np.tan(0.5 * fov) * random.uniform(-1.0, 1.0, 2)
        offset = random.normal(size=3)
        offset *= random.uniform(0.0, 400.0) / np.linalg.norm(offset)
        centre = (east, depth, 1000.0 + up) + random.uniform(0.0, 30_000.0) * sun + offset
        assert view.counts(centre, 400.0)
        kept += view.counts(random.uniform((-20e3, -20e3, 0), (20e3, 20e3, 9e3)), 400.0)
    assert kept < 600


def test_what_is_written_stays_the_same(tmp_path):
    puffs = smoke(3000.0, smallest=120.0)
    whole = volume.write_smoke(tmp_path / "whole.vdb", puffs, 120.0)
    view = volume.Sight([(4000.0, -9000.0, 1500.0)], [NORTH], [(0.3, 0.2)], (0.0, 0.6, 0.8))
    part = volume.write_smoke(tmp_path / "part.vdb", puffs, 120.0, sight=view)
    assert 0.05 * whole.active_voxels < part.active_voxels < 0.8 * whole.active_voxels
    assert part.mass + part.hidden == pytest.approx(whole.mass, rel=1e-9)
    assert part.hidden > 0.1 * whole.mass
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
