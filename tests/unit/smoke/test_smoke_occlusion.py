"""Smoke occluded by other smoke, against closed forms and marches through the same smoke."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import volume
from scipy.ndimage import gaussian_filter, map_coordinates

UP = (0.0, 0.0, 1.0)
SLANTED = np.array([0.55, -0.46, 0.70]) / np.linalg.norm([0.55, -0.46, 0.70])
NONE = np.empty((0, 3))
VOXEL = 20.0  # m


@pytest.fixture
def lumps():
    """Lumps of smoke eight voxels wide, 1/m, up to 30 deep."""
    noise = np.random.default_rng(3).normal(size=(72, 64, 56))
    found = gaussian_filter(noise, 4.0)
    found = np.clip(found / found.std() + 0.3, 0.0, None) * 0.015
    found[:3] = found[-3:] = found[:, :3] = found[:, -3:] = found[:, :, :3] = found[:, :, -3:] = 0.0
    return found.astype(np.float32)


def marched(smoke, voxel, places, eye, direction, steps=2):
    """Optical depths (n,) from places (n, 3) to an eye, or far away, by a fine march; lengths in voxels."""
    ways = np.broadcast_to(direction, places.shape) if eye is None else np.asarray(eye) - places
    length = np.linalg.norm(ways, axis=1)
    ways = ways / length[:, None]
    depth = np.zeros(len(places))
    for step in range(int(np.linalg.norm(smoke.shape) * steps)):
        far = (step + 0.5) / steps
        there = map_coordinates(smoke, (places + far * ways).T, order=1, mode="constant")
        depth += np.where((far < length) | (eye is None), there, 0.0) * voxel / steps
    return depth


def test_in_an_even_slab_what_is_deeper_than_asked_for_is_hidden():
    smoke = np.zeros((40, 40, 64), np.float32)
    smoke[:, :, 8:48] = 0.02
    hidden, _ = volume.occluded_smoke(smoke, VOXEL, NONE, [UP], 6.0)
    depth = 0.02 * VOXEL * (48 - np.arange(64) - 0.5)
    column = hidden[20, 20]
    assert set(np.unique(hidden)) == {0.0, 1.0}
    assert np.all(column[8:48][depth[8:48] < 5.8] == 0.0)
    assert np.all(column[8:48][depth[8:48] > 6.6] == 1.0)
    assert np.all(column[:8] == 0.0)  # no smoke


def test_from_an_eye_in_a_slab_what_lies_round_it_is_seen():
    smoke = np.full((64, 64, 64), 0.02, np.float32)
    hidden, _ = volume.occluded_smoke(smoke, VOXEL, [(32 * VOXEL, 32 * VOXEL, 32 * VOXEL)], NONE, 6.0)
    depth = 0.02 * VOXEL * np.linalg.norm(np.indices(smoke.shape) - 32.0, axis=0)
    assert np.all(hidden[depth < 5.8] == 0.0)
    assert np.all(hidden[depth > 6.9] == 1.0)


@pytest.mark.parametrize("eye", [(-300.0, 20.0, 60.0), (36.5, 32.5, 200.0), (30.5, 33.5, 29.5), None])
def test_of_lumps_what_is_seen_is_not_hidden_and_most_of_the_rest_is(lumps, eye):
    places = NONE if eye is None else np.array([eye]) * VOXEL
    found, _ = volume.occluded_smoke(lumps, VOXEL, places, [SLANTED] if eye is None else NONE, 6.0)
    some = np.random.default_rng(1).permutation(np.argwhere(lumps > 0.0))[:4000]
    hidden, depth = found[tuple(some.T)] > 0.0, marched(lumps, VOXEL, some, eye, SLANTED)
    assert not np.any(hidden[depth < 3.0])  # a gap between lumps narrower than the voxels that are marched
    assert hidden[depth < 5.0].mean() < 0.02
    assert hidden[depth > 8.0].mean() > 0.9


def test_what_one_eye_of_several_sees_is_not_hidden(lumps):
    eyes = np.array([(-300.0, 20.0, 60.0), (36.0, 32.0, 200.0)]) * VOXEL
    both, _ = volume.occluded_smoke(lumps, VOXEL, eyes, [SLANTED], 4.0)
    each = [volume.occluded_smoke(lumps, VOXEL, [eye], NONE, 4.0)[0] for eye in eyes]
    each.append(volume.occluded_smoke(lumps, VOXEL, NONE, [SLANTED], 4.0)[0])
    assert both.sum() > 0.0
    assert all(alone.sum() > both.sum() for alone in each)
    assert all(np.all(alone[both > 0.0] == 1.0) for alone in each)


def test_smoke_of_a_larger_brick_hides_too():
    smoke = np.full((16, 16, 16), 0.005, np.float32)
    around = np.zeros((16, 16, 24), np.float32)
    around[:, :, 16:20] = 0.02  # 6.4 deep, over all of it
    eye = [(160.0, 160.0, 9000.0)]
    alone, _ = volume.occluded_smoke(smoke, VOXEL, eye, NONE, 6.0)
    _, wall = volume.occluded_smoke(around, 4.0 * VOXEL, eye, NONE, 6.0, (-400.0, -400.0, -400.0))
    behind, _ = volume.occluded_smoke(smoke, VOXEL, eye, NONE, 6.0, (0.0, 0.0, 0.0), wall)
    before, _ = volume.occluded_smoke(
        smoke, VOXEL, [(160.0, 160.0, -9000.0)], NONE, 6.0, (0.0, 0.0, 0.0), wall
    )
    assert np.all(alone == 0.0)
    assert np.all(behind == 1.0)
    assert np.all(before == 0.0)


def test_the_smoke_that_hides_is_a_mean_of_four_voxels_a_side(lumps):
    _, (smoke, voxel, origin) = volume.occluded_smoke(lumps, VOXEL, NONE, [UP], 6.0, (10.0, 20.0, 30.0))
    assert smoke == pytest.approx(lumps.reshape(18, 4, 16, 4, 14, 4).mean((1, 3, 5)), rel=1e-5, abs=1e-9)
    assert (voxel, list(origin)) == (80.0, [40.0, 50.0, 60.0])


def test_without_eyes_nothing_is_hidden(lumps):
    hidden, _ = volume.occluded_smoke(lumps, VOXEL, NONE, NONE, 0.1)
    assert hidden.shape == lumps.shape
    assert np.all(hidden == 0.0)


def test_any_number_of_threads_hides_the_same(lumps, all_threads):
    found = []
    for threads in (1, 2):
        core.set_threads(threads)
        found.append(volume.occluded_smoke(lumps, VOXEL, [(0.0, 0.0, 9000.0)], [SLANTED], 6.0)[0])
    assert found[0].sum() > 0.0
    assert np.array_equal(found[0], found[1])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"extinction": np.ones((4, 4))}, "extinction must have shape"),
        ({"voxel_size": 0.0}, "voxel_size"),
        ({"places": [(0.0, 0.0)]}, "places must have shape"),
        ({"places": [(0.0, 0.0, np.nan)]}, "places"),
        ({"directions": [(1.0, 1.0, 1.0)]}, "directions must be unit vectors"),
        ({"depth": 0.0}, "depth"),
    ],
)
def test_what_makes_no_sense_is_refused(change, reason):
    right = {"extinction": np.ones((4, 4, 4)), "voxel_size": 1.0, "places": NONE, "directions": NONE}
    with pytest.raises(ValueError, match=reason):
        volume.occluded_smoke(**(right | {"depth": 6.0} | change))
