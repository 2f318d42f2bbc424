"""Outlines and noise below the voxel: sharper near the eye, the same smoke, and nothing far away."""

import numpy as np
import pytest
from firetwin_core import flow, volume
from flow_moments import VOXEL, N, moment
from march_light import NO_LIGHT

LIGHT = volume.Illumination(**NO_LIGHT)
COUNT = 48
UP = (0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def cloud():
    """A ball of dense young smoke, as bricks."""
    place = np.indices((N, N, N)) - 0.5 * (N - 1)
    smoke = 3e-6 * np.exp(-0.5 * (place**2).sum(axis=0) / 1.3**2)
    detail = flow.Detail(**moment(smoke=smoke, age=np.full((N, N, N), 30.0), rise=np.full((N, N, N), 4.0)))
    plane = np.ones((COUNT, COUNT))
    return volume.LitSmoke(
        detail.paint_sparse((0.0, 0.0, 0.0), VOXEL, 0.0 * plane, plane, 40), UP, 0.2, 0.5
    ).bricks(plane, 5e-5)


def through(cloud, pixel, spacing=2.0, count=160):
    """Transmittance (count, count) along x, through a square in the middle of the cloud."""
    along = (np.arange(count) - 0.5 * count) * spacing + 0.5 * COUNT * VOXEL
    y, z = (each.ravel() for each in np.meshgrid(along, along * 40 / COUNT))
    origins = np.stack([np.full(y.shape, -100.0), y, z], axis=1)
    ways = np.broadcast_to([1.0, 0.0, 0.0], origins.shape)
    ends = np.full((len(y), 1), 1e9)
    return volume.march([cloud], origins, ways, ends, LIGHT, pixel=pixel)[:, 0, 3].reshape(count, count)


def test_voxels_smaller_than_pixels_look_the_same(cloud):
    plain = through(cloud, (0.0, 0.0))
    assert 0.02 < plain.mean() < 0.98
    assert np.array_equal(through(cloud, (VOXEL, 0.0)), plain)


def test_smoke_near_the_eye_has_detail_below_the_voxel(cloud):
    plain, near = through(cloud, (0.0, 0.0)), through(cloud, (0.5, 0.0))
    finest = [np.abs(np.diff(each, 2, axis=1)).mean() for each in (plain, near)]
    assert finest[1] > 2.0 * finest[0]


def test_detail_neither_adds_smoke_nor_takes_it_away(cloud):
    plain, near = through(cloud, (0.0, 0.0)), through(cloud, (0.5, 0.0))
    assert near.mean() == pytest.approx(plain.mean(), abs=0.04)


def test_outlines_are_spread_over_voxels_so_that_they_draw_no_stairs():
    """Hardly any voxel of clear air has a neighbour in the thickest smoke."""
    place = np.indices((N, N, N)) - 0.5 * (N - 1)
    smoke = 3e-6 * np.exp(-0.5 * (place**2).sum(axis=0) / 1.3**2)
    detail = flow.Detail(**moment(smoke=smoke, age=np.full((N, N, N), 30.0), rise=np.full((N, N, N), 4.0)))
    plane = np.ones((COUNT, COUNT))
    density = detail.paint((0.0, 0.0, 0.0), VOXEL, 0.0 * plane, plane, 40)[0]
    low, high = np.minimum(density[1:], density[:-1]), np.maximum(density[1:], density[:-1])
    outline = (low < 0.1 * density.max()) & (high > 0.3 * density.max())
    assert (high[outline] > 0.8 * density.max()).mean() < 0.2


def test_a_slanting_outline_is_straight_between_voxels():
    """The surface of smoke whose outline is a voxel wide has no stairs."""
    count, slope = 40, 0.15
    x, y, _z = np.indices((count, count, 8), dtype=float)
    edge = np.clip(0.5 + y - 20.0 - slope * (x - 20.0), -1.0, 2.0)
    density = np.clip(edge, 0.0, 1.0)
    even = np.ones_like(density)
    wall = volume.Bricks(density, even, even, even, None, 1.0, (0.0, 0.0, 0.0), edge)
    across, along = np.linspace(10.0, 30.0, 161), np.linspace(15.0, 25.0, 401)
    places = np.stack([*np.meshgrid(across, along, indexing="ij"), np.full((161, 401), -1.0)], axis=-1)
    ends = np.full((places.size // 3, 1), 1e9)
    ways = np.broadcast_to([0.0, 0.0, 1.0], (len(ends), 3))
    found = volume.march([wall], places.reshape(-1, 3), ways, ends, LIGHT, pixel=(0.05, 0.0))
    surface = along[np.argmax(found[..., 3].reshape(161, 401) < 0.5, axis=1)]
    stairs = surface - np.polyval(np.polyfit(across, surface, 1), across)
    assert stairs.std() < 0.03


def test_smoke_across_the_faces_of_blocks_has_no_step():
    """A level sheet of an outline looks the same everywhere, though its rays cross blocks at other places."""
    count = 48
    x = np.indices((count, count, 8), dtype=float)[0]
    sheet = np.where(x == 20.0, 0.4, 0.0)
    even = np.ones_like(sheet)
    edge = np.full_like(sheet, 0.4)
    smoke = volume.Bricks(0.05 * sheet, even, even, even, None, 20.0, (0.0, 0.0, 0.0), edge)
    y = np.linspace(100.0, 420.0, 321)
    origins = np.stack([np.full(y.shape, -200.0), y, np.full(y.shape, 70.0)], axis=1)
    ways = np.broadcast_to(np.array([1.0, 0.5, 0.0]) / np.sqrt(1.25), origins.shape)
    ends = np.full((len(y), 1), 1e9)
    clear = volume.march([smoke], origins, ways, ends, LIGHT, step=0.05, pixel=(0.0, 0.01))[:, 0, 3]
    assert 0.2 < clear.mean() < 0.98
    assert np.ptp(clear) < 0.01 * (1.0 - clear.mean())
