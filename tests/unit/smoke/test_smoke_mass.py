"""Smoke is neither lost nor made, and a steady plume rises as high as Briggs says, in puffs and in files."""

import numpy as np
import pytest
from firetwin_core import volume
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from plumes import CELL, briggs, burn, read, smoke, steady


def burned(cells, time, burn_time):
    """kg of fuel gone by `time`, cell by cell."""
    arrival, fuel, _ = cells
    return np.sum(fuel * CELL**2 * np.clip((time - arrival) / burn_time, 0.0, 1.0))


@settings(deadline=None, max_examples=examples(60))
@given(
    time=st.floats(-100.0, 20_000.0),
    max_age=st.floats(30.0, 8000.0),
    interval=st.floats(10.0, 300.0),
    burn_time=st.floats(60.0, 2000.0),
    block=st.floats(50.0, 3000.0),
    fraction=st.floats(0.001, 0.1),
    seed=st.integers(0, 2**63),
)
def test_emitted_is_airborne_and_left(time, max_age, interval, burn_time, block, fraction, seed):
    cells = burn(25, seed=seed % 1000)
    found = smoke(
        time,
        cells=cells,
        max_age=max_age,
        interval=interval,
        burn_time=burn_time,
        block=block,
        smoke_fraction=fraction,
        smallest=400.0,
        seed=seed,
    )
    emitted = fraction * burned(cells, time, burn_time)
    assert found.emitted == pytest.approx(emitted, rel=1e-9)
    assert found.mass.sum() + found.left == pytest.approx(emitted, rel=1e-6)
    assert found.mass.min(initial=0.0) >= 0.0
    assert found.left >= -1e-9 * emitted


@settings(deadline=None, max_examples=examples(12))
@given(time=st.floats(60.0, 6000.0), voxel=st.floats(90.0, 250.0), seed=st.integers(0, 99))
@example(time=60.0, voxel=197.6875, seed=34)  # few voxels, all rounded down: 3.2e-4
def test_a_file_holds_the_airborne_mass(tmp_path_factory, time, voxel, seed):
    """1e-6 before values become half floats, which are off by 2^-11 of themselves at most; so is the sum."""
    path = tmp_path_factory.mktemp("mass") / "smoke.vdb"
    puffs = smoke(time, cells=burn(30, seed), smallest=150.0, max_age=4000.0)
    frame = volume.write_smoke(path, puffs, voxel)
    if frame.active_voxels == 0:  # everywhere below the visible dilution of 0.002
        assert puffs.mass.sum() < 100.0
    else:
        assert frame.mass == pytest.approx(puffs.mass.sum(), rel=1e-6)
        dilution = read(path)["dilution"][0].astype(np.float64)
        assert dilution.sum() * volume.FRESH_SMOKE * voxel**3 == pytest.approx(puffs.mass.sum(), rel=2.0**-11)


@pytest.mark.parametrize("voxel", [60.0, 110.0])
def test_small_puffs_do_not_flicker_as_they_drift(tmp_path, voxel):
    """Smoke over one young fire moves past the voxels without coming and going."""
    found = []
    for shift in np.linspace(0.0, 4.0 * voxel, 9):
        cell = np.array([0.0]), np.array([4.0]), np.array([[shift, 0.6 * shift, 1000.0]])
        puffs = volume.puffs(30.0, *cell, (3.0, 0.0), CELL**2)
        path = tmp_path / "smoke.vdb"
        frame = volume.write_smoke(path, puffs, voxel)
        assert frame.mass == pytest.approx(puffs.mass.sum(), rel=1e-6)
        found.append((frame.active_voxels, read(path)["dilution"][0].max()))
    voxels, thickest = np.array(found).T
    assert voxels.min() > 0.5 * voxels.max()
    assert thickest.max() < 3.0 * thickest.min()


@pytest.mark.parametrize(("power", "wind"), [(1.0e10, 5.0), (5.0e10, 8.0), (2.0e9, 3.0)])
def test_a_steady_plume_in_a_file_is_as_high_as_briggs_says(tmp_path, power, wind):
    """Mean height within 2 % of the rise or half a voxel; the top within a voxel of the top of the puffs."""
    voxel, ground, path = 100.0, 500.0, tmp_path / "plume.vdb"
    puffs = volume.puffs(
        7000.0, *steady(power), (wind, 0.0), CELL**2, max_age=6000.0, burn_time=7200.0, turbulence=0.0
    )
    volume.write_smoke(path, puffs, voxel)
    fire = np.sqrt(power / (np.pi * 1.0e5))
    rise = briggs(power, wind, 1.0e-4)
    level = (puffs.mass > 0.0) & (puffs.age > 2500.0) & (puffs.age < 3000.0)  # risen, and not yet fading
    low, high = np.percentile(puffs.position[level, 0], [5.0, 95.0])

    grids = read(path)
    dilution, corner = grids["dilution"]
    x, z = (voxel * (corner[axis] + np.arange(dilution.shape[axis])) for axis in (0, 2))
    part = dilution[(x >= low) & (x <= high)].astype(np.float64)
    middle = np.sum(part.sum((0, 1)) * z) / part.sum()
    assert middle - ground - 0.8 * fire == pytest.approx(rise, rel=0.02, abs=0.5 * voxel)

    density, corner = grids["density"]
    assert np.array_equal(corner, grids["dilution"][1])
    inside = density[(x >= low) & (x <= high)] >= 0.5  # the surface of the puffs
    top = z[inside.any((0, 1))].max()
    # The puffs' radius, see cpp/volume/puffs.hpp; balls on their surface stick out by up to 0.85 of 0.5 R.
    radius = fire + 0.3 * rise + 0.02 * 0.5 * (low + high)
    highest = ground + 0.8 * fire + rise + radius
    assert highest - voxel < top < highest + 0.425 * radius + voxel
    assert top == pytest.approx((puffs.position[level, 2] + puffs.radius[level]).max(), rel=0.12)
