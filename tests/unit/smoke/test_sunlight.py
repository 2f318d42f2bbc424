"""Light of sun and sky in bricks of smoke, against closed forms and marches through the same smoke."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import volume
from scipy.ndimage import gaussian_filter, map_coordinates, maximum_filter

UP = (0.0, 0.0, 1.0)
SLANTED = np.array([0.55, -0.46, 0.70]) / np.linalg.norm([0.55, -0.46, 0.70])


@pytest.fixture
def cloud():
    """Lumps of smoke, 1/m, up to 25 deep."""
    noise = np.random.default_rng(3).normal(size=(44, 40, 36))
    lumps = gaussian_filter(noise, 3.0)
    smoke = np.clip(lumps / lumps.std() - 0.5, 0.0, None) * 0.02
    smoke[:3] = smoke[-3:] = smoke[:, :3] = smoke[:, -3:] = smoke[:, :, :3] = smoke[:, :, -3:] = 0.0
    return smoke.astype(np.float32)


def marched(smoke, voxel, direction, steps=8):
    """Optical depth by a fine march through smoke that is linear between voxels."""
    places = np.stack(np.indices(smoke.shape)).reshape(3, -1).astype(float)
    way, depth = 1.0 / steps, np.zeros(places.shape[1])
    for step in range(int(np.linalg.norm(smoke.shape) * steps)):
        at = places + (step + 0.5) * way * np.asarray(direction)[:, None]
        depth += map_coordinates(smoke, at, order=1, mode="constant") * way * voxel
    return depth.reshape(smoke.shape)


def test_the_sun_over_an_even_slab():
    smoke = np.full((9, 9, 30), 0.002, np.float32)
    sun, _, _ = volume.smoke_light(smoke, 20.0, UP, 1.0, 1.0)
    under = (30 - np.arange(30) - 0.5) * 20.0
    assert sun[4, 4, 2:24] == pytest.approx(np.exp(-0.002 * under[2:24]), rel=0.05)


@pytest.mark.parametrize("direction", [UP, SLANTED, SLANTED * (-1, -1, 1), SLANTED[[2, 0, 1]]])
def test_the_sun_in_lumps_is_as_a_fine_march_finds_it(cloud, direction):
    sun, _, _ = volume.smoke_light(cloud, 20.0, direction, 0.25, 1.0)
    expected = np.exp(-0.25 * marched(cloud, 20.0, direction))
    inside = cloud > 0.0
    inside[:6] = inside[-6:] = inside[:, :6] = inside[:, -6:] = inside[:, :, -6:] = False
    assert np.abs(sun - expected)[inside].mean() < 0.05  # 0.02 to 0.042, of lumps six voxels wide
    assert np.corrcoef(sun[inside], expected[inside])[0, 1] > 0.95


def test_what_lies_beyond_a_brick_dims_it_too(cloud):
    whole, _, depths = volume.smoke_light(cloud, 20.0, SLANTED, 0.25, 1.0)
    low = 10
    part = np.ascontiguousarray(cloud[low:-low, low:-low, :-low])
    place = (20.0 * low, 20.0 * low, 0.0)
    with_rest, _, _ = volume.smoke_light(part, 20.0, SLANTED, 0.25, 1.0, place, depths)
    alone, _, _ = volume.smoke_light(part, 20.0, SLANTED, 0.25, 1.0, place)
    inside, same = part > 0.0, whole[low:-low, low:-low, :-low]
    assert np.abs(with_rest - same)[inside].mean() < 0.05
    assert np.abs(alone - same)[inside].mean() > 0.1


def test_the_sky_over_an_even_slab():
    smoke = np.zeros((240, 240, 24), np.float32)
    smoke[:, :, 8:16] = 0.004
    _, sky, _ = volume.smoke_light(smoke, 20.0, UP, 1.0, 0.5)
    beneath = 0.5 * 0.004 * 8 * 20.0
    expected = 0.2 * np.exp(-beneath) + 0.8 * np.exp(-beneath / 0.4)
    assert sky[120, 120, 7] == pytest.approx(expected, abs=0.03)
    assert sky[120, 120, 16] == pytest.approx(1.0, abs=0.1)


def test_finer_smoke_within_other_smoke_has_no_brighter_sky_at_its_sides():
    coarse, fine, low = 40.0, 40.0 / 3.0, 22
    slab = np.full((60, 60, 20), 0.004, np.float32)
    slab[:, :, 12:] = 0.0
    _, outer, depths = volume.smoke_light(slab, coarse, UP, 0.25, 0.5)
    part = np.full((48, 48, 60), 0.004, np.float32)
    part[:, :, 36:] = 0.0
    origin = np.array([low * coarse, low * coarse, 0.0]) - 0.5 * (coarse - fine)
    _, inner, _ = volume.smoke_light(part, fine, UP, 0.25, 0.5, origin, depths)
    _, alone, _ = volume.smoke_light(part, fine, UP, 0.25, 0.5, origin)
    places = (np.stack(np.indices(part.shape)) * fine + origin[:, None, None, None]) / coarse
    around = map_coordinates(outer, places, order=1, mode="nearest")
    for side in (np.s_[0, :, :30], np.s_[-1, :, :30], np.s_[:, 0, :30], np.s_[:, -1, :30]):
        assert inner[side] == pytest.approx(around[side], abs=0.05), "of 0.2 at the bottom, 0.7 at the top"
        assert np.abs(alone[side] - around[side]).mean() > 0.2


def test_light_is_known_in_smoke_and_a_voxel_round_it_alone(cloud):
    sun, sky, _ = volume.smoke_light(cloud, 20.0, SLANTED, 0.25, 0.5)
    near = maximum_filter(cloud, 3, mode="constant") > 0.0
    for light in (sun, sky):
        assert np.array_equal(light > 0.0, near)
        assert light.max() <= 1.0


def test_any_number_of_threads_finds_the_same_light(cloud, all_threads):
    found = []
    for threads in (1, 2):
        core.set_threads(threads)
        found.append(volume.smoke_light(cloud, 20.0, SLANTED, 0.25, 0.5)[:2])
    assert np.array_equal(found[0], found[1])


def test_flat_arrays_are_refused():
    with pytest.raises(ValueError, match="extinction must have shape"):
        volume.smoke_light(np.ones((4, 4)), 20.0, UP, 1.0, 1.0)


@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (np.nan, 0.0, 1.0)])
def test_what_is_no_direction_is_refused(direction):
    with pytest.raises(ValueError, match="direction"):
        volume.smoke_light(np.ones((4, 4, 4)), 20.0, direction, 1.0, 1.0)


def test_voxels_without_size_are_refused():
    with pytest.raises(ValueError, match="voxel_size"):
        volume.smoke_light(np.ones((4, 4, 4)), 0.0, UP, 1.0, 1.0)
