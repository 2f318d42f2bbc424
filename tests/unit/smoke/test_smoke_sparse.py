"""Smoke that is painted, lit and packed in blocks is the same, bit by bit, as in dense arrays."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import flow, volume
from flow_moments import VOXEL, N, moment
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

THIN, PARTS = 5.0e-5, (0.2, 0.5)
SLANTED = np.array([0.55, -0.46, 0.70]) / np.linalg.norm([0.55, -0.46, 0.70])
LIGHT = volume.Illumination(
    density=1.0,
    fresh=(0.9, 0.8, 0.7),
    old=(0.5, 0.6, 0.7),
    sun=(1.0, 2.0, 3.0),
    sky=(0.1, 0.2, 0.3),
    sun_direction=(0.0, 0.0, 1.0),
    anisotropy=0.6,
    multiple_scattering=(0.4, 0.2),
    glow=(1.0, 0.5, 0.2),
    thin=0.3,
    air=(0.0, 0.0, 0.0),
    horizon=(0.0, 0.0, 0.0),
    thick_haze=(0.2, 1.2),
    haze=(0.0, 0.0),
    haze_height=(2000.0, 800.0),
)


def smoke_of(seed, cells, glows):
    """A few lumps of smoke of any age, some of which rise, and their painted voxels."""
    rng = np.random.default_rng(seed)
    smoke = np.zeros((N, N, N))
    smoke[tuple(rng.integers(0, N, (3, cells)))] = 10.0 ** rng.uniform(-9.0, -5.0, cells)
    some = {
        "smoke": smoke,
        "age": rng.uniform(0.0, 900.0, (N, N, N)),
        "rise": rng.uniform(-2.0, 4.0, (N, N, N)),
        "glow": rng.uniform(0.0, 1.0, (N, N, N)) if glows else None,
    }
    return flow.Detail(**moment(**some)), rng


def dense(detail, shape, end, share, direction, beyond):
    """All of it with whole arrays and NumPy: what `volume.Bricks` is made from, and depths to the sun."""
    nx, ny, nz = shape
    density, fresh, glow = detail.paint((0.0, 0.0, 0.0), VOXEL, np.zeros((nx, ny)), end, nz)
    density[density < THIN] = 0.0
    sun, sky, depths = volume.smoke_light(density, VOXEL, direction, *PARTS, (0.0, 0.0, 0.0), beyond)
    density *= share[:, :, None]
    density[density < THIN] = 0.0
    return {"density": density, "fresh": fresh, "sun": sun, "sky": sky, "glow": glow}, depths


def sparse(detail, shape, end, direction, beyond):
    nx, ny, nz = shape
    what = (0.0, 0.0, 0.0), VOXEL, np.zeros((nx, ny)), end, nz
    return volume.LitSmoke(detail.paint_sparse(*what, min_extinction=THIN), direction, *PARTS, beyond)


def seen(bricks):
    """Results of rays up each column of voxels, and along as many slanted paths."""
    shape = np.array(bricks.shape)
    i, j = (at.ravel() for at in np.indices(shape[:2]))
    up = np.stack([i, j, np.zeros_like(i)], axis=1) * VOXEL
    rng = np.random.default_rng(1)
    ends = rng.uniform(0.0, 1.0, (2, 2000, 3)) * (shape - 1) * VOXEL
    ways = ends[1] - ends[0]
    lengths = np.linalg.norm(ways, axis=1)
    taps = np.linspace(VOXEL, (shape[2] - 1) * VOXEL, 24, dtype=np.float32)
    straight = np.broadcast_to((0.0, 0.0, 1.0), up.shape), np.broadcast_to(taps, (len(up), 24))
    slanted = ways / lengths[:, None], lengths[:, None].astype(np.float32)
    marched = [
        volume.march([bricks], origins, *rays, LIGHT)
        for origins, rays in ((up, straight), (ends[0], slanted))
    ]
    return [*marched, volume.optical_depth([bricks], ends[0], slanted[0], slanted[1][:, 0])]


@settings(max_examples=examples(12), deadline=None)
@given(
    seed=st.integers(0, 99),
    cells=st.integers(1, 12),
    shape=st.tuples(*(st.integers(30, 48),) * 3),
    glows=st.booleans(),
    direction=st.sampled_from([SLANTED, SLANTED * (-1, 1, 1), SLANTED[[2, 0, 1]], (0.0, 0.0, 1.0)]),
)
def test_blocks_hold_what_dense_arrays_do(seed, cells, shape, glows, direction):
    detail, rng = smoke_of(seed, cells, glows)
    end = rng.uniform(0.5, 1.0, shape[:2])
    share = np.clip(rng.uniform(-0.5, 1.5, shape[:2]), 0.0, 1.0)
    around = rng.uniform(0.0, 0.004, (18, 18, 18))
    *_, beyond = volume.smoke_light(around, 80.0, direction, *PARTS, (-120.0, -120.0, -120.0))
    grids, depths = dense(detail, shape, end, share, direction, beyond)
    lit = sparse(detail, shape, end, direction, beyond)
    found = lit.grids(share, THIN)
    assert set(found) == {name for name, values in grids.items() if values is not None}
    there = grids["density"] > 0.0
    for name, values in found.items():
        where = np.ones_like(there) if name in ("density", "sun", "sky") else there
        assert np.array_equal(values[where], grids[name][where]), name
    assert np.array_equal(lit.depths.sun, depths.sun)
    one = volume.Bricks(**grids, voxel_size=VOXEL, origin=(0.0, 0.0, 0.0))
    other = lit.bricks(share, THIN)
    assert (one.used, one.bytes, one.shape) == (other.used, other.bytes, other.shape)
    for first, second in zip(seen(one), seen(other), strict=True):
        assert np.array_equal(first, second)


def test_any_number_of_threads_makes_the_same_bricks(all_threads):
    detail, _ = smoke_of(5, 12, True)
    whole, found = np.ones((48, 48)), []
    for threads in (1, 3):
        core.set_threads(threads)
        found.append(seen(sparse(detail, (48, 48, 40), whole, SLANTED, None).bricks(whole, THIN)))
    assert found[0][0][..., :3].max() > 0.0
    for one, three in zip(*found, strict=True):
        assert np.array_equal(one, three)


def test_only_blocks_with_smoke_are_kept():
    detail = flow.Detail(**moment())
    plane = np.zeros((48, 48))
    smoke = detail.paint_sparse((0.0, 0.0, 0.0), VOXEL, plane, plane + 1.0, 40, min_extinction=THIN)
    assert 0 < smoke.used < 6 * 6 * 5
    assert (smoke.shape, smoke.voxel_size, smoke.origin) == ([48, 48, 40], VOXEL, [0.0, 0.0, 0.0])
    none = detail.paint_sparse((0.0, 0.0, 0.0), VOXEL, plane, plane, 40)
    assert none.used == 0
    assert volume.LitSmoke(none, SLANTED, *PARTS).bricks(plane + 1.0, THIN).used == 0


def test_the_light_of_flames_falls_off_in_the_smoke_above_them():
    """A glow that no smoke dimmed made a sky of one tone."""
    detail = flow.Detail(**moment(glow=np.ones((N, N, N))))
    plane = np.ones((48, 48))
    smoke = detail.paint_sparse((0.0, 0.0, 0.0), VOXEL, 0.0 * plane, plane, 40, min_extinction=THIN)
    grids = []
    for part in (0.0, 0.5):
        smoke.dim_glow(part)
        grids.append(volume.LitSmoke(smoke, SLANTED, *PARTS).grids(plane, THIN))
    density = grids[0]["density"]
    below = VOXEL * (np.cumsum(density, axis=2) - 0.5 * density)
    there = (density > 0.0) & (grids[0]["glow"] > 0.5)
    kept = -np.log(grids[1]["glow"][there] / grids[0]["glow"][there])
    assert kept.max() > 1.0
    for low, high in ((0.5, 1.0), (2.0, 3.0)):
        deep = (below[there] > low) & (below[there] < high)
        assert np.median(kept[deep] / below[there][deep]) == pytest.approx(0.5, rel=0.2)


def test_a_share_of_another_shape_is_refused():
    detail = flow.Detail(**moment())
    plane = np.ones((48, 48))
    lit = sparse(detail, (48, 48, 40), plane, SLANTED, None)
    with pytest.raises(ValueError, match="share must have shape"):
        lit.bricks(plane[1:], THIN)
    with pytest.raises(ValueError, match="direction"):
        sparse(detail, (48, 48, 40), plane, (1.0, 1.0, 1.0), None)
