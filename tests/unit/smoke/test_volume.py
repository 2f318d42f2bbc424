"""Smoke: puffs in closed form, and volumes on disk."""

import shutil
import subprocess

import numpy as np
import pytest
from firetwin_core import Error, InputError, volume
from plumes import CELL, briggs, burn, read, smoke, steady


@pytest.mark.parametrize("time", [30.0, 1000.0, 3000.0, 4100.0])
def test_emitted_smoke_is_two_hundredths_of_the_burned_fuel(time):
    arrival, fuel, _ = burn()
    found = smoke(time, max_age=1.0e5)
    burned = np.sum(fuel * CELL**2 * np.clip((time - arrival) / 600.0, 0.0, 1.0))
    assert found.emitted == pytest.approx(0.02 * burned, rel=1e-9)
    assert found.mass.sum() == pytest.approx(0.02 * burned, rel=1e-6)


def test_what_is_emitted_is_in_the_air_or_has_left():
    found = smoke(4000.0, max_age=1500.0)
    assert found.left > 0.1 * found.emitted
    assert found.mass.sum() + found.left == pytest.approx(found.emitted, rel=1e-6)


def test_the_state_depends_on_the_time_alone():
    first = smoke(2000.0)
    smoke(3000.0)
    again = smoke(2000.0)
    for name in ("position", "radius", "mass", "identity"):
        assert np.array_equal(getattr(first, name), getattr(again, name))
    assert len(np.unique(first.identity)) == len(first)


@pytest.mark.parametrize("time", [599.7, 1799.9, 2400.0, 3333.3])
def test_nothing_pops(time):
    """Over a tenth of a second balls move by metres, and those that come or go have no size or mass."""
    before, after = smoke(time, max_age=2000.0), smoke(time + 0.1, max_age=2000.0)
    _, old, new = np.intersect1d(before.identity, after.identity, return_indices=True)
    assert len(old) > 100
    assert np.abs(before.position[old] - after.position[new]).max() < 40.0
    assert np.abs(before.radius[old] - after.radius[new]).max() < 8.0
    for state, kept in ((before, old), (after, new)):
        alone = np.setdiff1d(np.arange(len(state)), kept)
        assert state.mass[alone].sum() < 1e-3 * state.mass.sum()
        assert np.all((state.radius[alone] < 30.0) | (state.density[alone] < 1e-7))


@pytest.mark.parametrize(("power", "wind"), [(1.0e10, 5.0), (5.0e10, 8.0), (2.0e9, 3.0)])
def test_a_steady_plume_levels_off_where_briggs_says(power, wind):
    found = volume.puffs(
        7000.0, *steady(power), (wind, 0.0), CELL**2, max_age=6000.0, burn_time=7200.0, turbulence=0.0
    )
    old = (found.mass > 0.0) & (found.age > 3000.0) & (found.age < 5000.0)
    fire = np.sqrt(power / (np.pi * 1.0e5))
    rise = found.position[old, 2] - 500.0 - 0.8 * fire
    assert old.sum() > 10
    assert rise == pytest.approx(briggs(power, wind, 1.0e-4), rel=0.003)


def test_neighbouring_fires_rise_as_one():
    arrival, fuel, _ = steady()
    place = np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]])
    settings = {"max_age": 6000.0, "burn_time": 7200.0, "turbulence": 0.0}
    two = np.repeat(arrival, 2), np.repeat(fuel, 2), place
    alone = volume.puffs(5000.0, arrival, fuel, place[:1], (5.0, 0.0), CELL**2, **settings)
    merged = volume.puffs(5000.0, *two, (5.0, 0.0), CELL**2, **settings)
    near = volume.puffs(5000.0, *two, (5.0, 0.0), CELL**2, merge_radius=1.0, **settings)

    def top(found):
        return np.median(found.position[(found.mass > 0.0) & (found.age > 3000.0), 2])

    share = np.exp(-((900.0 / 2000.0) ** 2))
    assert top(merged) / top(alone) == pytest.approx((1.0 + share) ** (1.0 / 3.0), rel=0.03)
    assert top(near) == pytest.approx(top(alone), rel=0.001)


def test_smoke_goes_with_the_wind():
    found = smoke(4000.0, wind=(0.0, -7.0))
    old = found.age > 1500.0
    assert found.position[old, 1].max() < -5000.0


def test_a_smoke_file_holds_the_mass_of_the_puffs(tmp_path):
    puffs = smoke(3000.0, smallest=100.0)
    path = tmp_path / "smoke.vdb"
    frame = volume.write_smoke(path, puffs, 100.0)
    assert frame.mass == pytest.approx(puffs.mass.sum(), rel=1e-6)
    assert frame.bytes == path.stat().st_size
    dilution = read(path)["dilution"][0].astype(np.float64)
    assert dilution.sum() * volume.FRESH_SMOKE * 100.0**3 == pytest.approx(frame.mass, rel=1e-4)
    assert list(tmp_path.iterdir()) == [path]


def test_density_is_the_clipped_distance_into_the_balls(tmp_path):
    puffs = smoke(1500.0, smallest=120.0)
    path = tmp_path / "smoke.vdb"
    volume.write_smoke(path, puffs, 120.0)
    density, low = read(path)["density"]
    random = np.random.default_rng(0)
    for voxel in random.permutation(np.argwhere(density > 0.0))[:200]:
        place = (voxel + low) * 120.0
        depth = np.max(puffs.radius - np.linalg.norm(puffs.position - place, axis=1))
        assert density[tuple(voxel)] == pytest.approx(np.clip((depth + 300.0) / 600.0, 0.0, 1.0), abs=1e-3)


@pytest.mark.parametrize("voxel", [40.0, 70.0, 130.0, 300.0])
def test_every_voxel_of_small_smoke_is_right(tmp_path, voxel):
    """Few, small puffs, whose balls reach farther than their mass."""
    puffs = smoke(900.0, cells=burn(6), smallest=60.0)
    path = tmp_path / "smoke.vdb"
    volume.write_smoke(path, puffs, voxel)
    grids = read(path)
    density, low = grids["density"]
    voxels = np.random.default_rng(2).integers(0, density.shape, (3000, 3))
    chosen = tuple(voxels.T)
    gap = np.linalg.norm(puffs.position[None] - ((voxels + low) * voxel)[:, None], axis=2)
    nearest = np.argmax(puffs.radius - gap, axis=1)
    depth = np.max(puffs.radius - gap, axis=1)
    there = grids["dilution"][0][chosen] > 0.0
    expected = np.clip((depth + 300.0) / 600.0, 0.0, 1.0)
    assert density[chosen][there] == pytest.approx(expected[there], abs=1e-3)
    assert not there[depth < -150.1].any()
    sized = there & (depth < 299.0)
    size = np.minimum(puffs.radius[nearest] / 1000.0, 1.0)
    assert grids["size"][0][chosen][sized] == pytest.approx(size[sized], abs=1e-3)


def test_flames_make_glow_that_falls_off(tmp_path):
    puffs = smoke(1500.0)
    path = tmp_path / "smoke.vdb"
    flame = np.array([[1200.0, 0.0, 1020.0]])
    volume.write_smoke(path, puffs, 100.0, flame, np.array([1.0e9]))
    grids = read(path)
    assert set(grids) == {"density", "dilution", "shade", "size", "temperature", "glow", "flame"}
    glow, low = grids["glow"]
    voxel = np.argwhere(glow > 0.0)
    distance = np.linalg.norm((voxel + low) * 100.0 - flame, axis=1)
    expected = np.exp(-distance / 1100.0) / (1.0 + (distance / 250.0) ** 2)
    far = distance > 700.0  # nearer, the nodes are too far apart to follow the peak
    assert glow[tuple(voxel[far].T)] == pytest.approx(expected[far], abs=0.02)
    assert 0.3 < glow.max() <= 1.0
    kelvin = grids["temperature"][0]
    assert kelvin[kelvin > 0.0].min() > 200.0
    assert kelvin.max() <= 1500.0


def test_no_smoke_still_makes_a_file(tmp_path):
    nothing = smoke(-10.0)
    assert len(nothing) == 0
    frame = volume.write_smoke(tmp_path / "none.vdb", nothing, 100.0)
    assert (frame.active_voxels, frame.mass) == (0, 0.0)


def test_vdb_print_reads_the_file(tmp_path):
    if shutil.which("vdb_print") is None:
        pytest.skip("vdb_print is not installed")
    path = tmp_path / "smoke.vdb"
    volume.write_smoke(path, smoke(1500.0), 100.0, metadata={"run": "a test"})
    told = subprocess.run(["vdb_print", "-l", path], capture_output=True, text=True, check=True).stdout
    assert "a test" in told
    assert "is_saved_as_half_float: true" in told
    assert "blosc + active values" in told
    assert "units: K" in told


def test_dense_arrays_come_back(tmp_path):
    random = np.random.default_rng(1)
    dense = random.random((9, 12, 20), dtype=np.float32)
    dense[dense < 0.5] = 0.0
    path = tmp_path / "dense.vdb"
    frame = volume.write(path, {"density": dense}, 10.0, origin=(5.0, 6.0, 7.0), half=False)
    assert frame.mass == pytest.approx(dense.sum(dtype=np.float64) * 1000.0, rel=1e-6)
    assert frame.active_voxels == np.count_nonzero(dense)
    found, low = read(path)["density"]
    inside = tuple(slice(a, a + n) for a, n in zip(low, found.shape, strict=True))
    assert np.array_equal(found, dense[inside])
    assert frame.bounds[0] == pytest.approx(np.array([5.0, 6.0, 7.0]) + 10.0 * (low - 0.5))


def test_half_grids_refuse_what_they_cannot_hold(tmp_path):
    field = np.full((2, 2, 2), 70_000.0, np.float32)
    with pytest.raises(ValueError, match="65504"):
        volume.write(tmp_path / "flux.vdb", {"heat": field}, 1.0)
    volume.write(tmp_path / "flux.vdb", {"heat": field}, 1.0, half=False)


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(InputError, match="no such folder") as caught:
        volume.write_smoke(tmp_path / "none" / "smoke.vdb", smoke(100.0), 100.0)
    assert caught.value.path == str(tmp_path / "none")


@pytest.mark.parametrize("voxel", [0.0, -1.0, float("nan"), 5e-324, 1e-300, 1e-9, 1e9, 1e300])
def test_a_bad_voxel_size_is_refused(tmp_path, voxel):
    with pytest.raises(ValueError, match="voxel_size"):
        volume.write_smoke(tmp_path / "smoke.vdb", smoke(100.0), voxel)


@pytest.mark.parametrize("voxel", [1e-4, 1e-3, 0.05])
def test_voxels_far_too_small_are_refused(tmp_path, voxel):
    with pytest.raises(Error, match="too small for smoke of this extent; use larger voxels"):
        volume.write_smoke(tmp_path / "smoke.vdb", smoke(100.0), voxel)
    assert not list(tmp_path.iterdir())


def test_flames_too_far_away_to_be_counted_are_refused(tmp_path):
    lit = {"flame_position": [[1.0e6, 0.0, 0.0]], "flame_power": [1.0e9]}
    with pytest.raises(Error, match="too small"):
        volume.write_smoke(tmp_path / "smoke.vdb", smoke(-10.0), 1e-4, **lit)


def test_bad_cells_are_refused():
    arrival, fuel, position = burn()
    with pytest.raises(ValueError, match="do not burn"):
        smoke(0.0, cells=(np.full_like(arrival, np.nan), fuel, position))
    with pytest.raises(ValueError, match="shape"):
        smoke(0.0, cells=(arrival, fuel[:-1], position))
    with pytest.raises(ValueError, match="stability must be finite and above 0"):
        smoke(0.0, stability=0.0)
    for interval in (1e-300, 0.5):  # would make more puffs than there is time for
        with pytest.raises(ValueError, match="interval is too short"):
            smoke(100.0, interval=interval, max_age=6000.0)


def test_what_cannot_be_put_in_place_leaves_nothing(tmp_path):
    (tmp_path / "smoke.vdb").mkdir()
    with pytest.raises(InputError, match="cannot be written"):
        volume.write_smoke(tmp_path / "smoke.vdb", smoke(100.0), 100.0)
    assert [path.name for path in tmp_path.iterdir()] == ["smoke.vdb"]
