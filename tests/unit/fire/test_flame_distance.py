"""Distance of flames along rays."""

import numpy as np
import pytest
from firetwin.render import flame_distance
from firetwin.render.rays import Rays
from firetwin_core import volume
from flame_field import flames, front
from march_light import NO_LIGHT

LIGHT = volume.Illumination(**NO_LIGHT)


def line(away):
    """Flames of 6 m on level ground at y from `away`, m, which move towards the camera."""
    return flames(front(6.0, half=(5.0, 20.0), DISTANCE=lambda x, y: y - away, NORTH=-1.0))


@pytest.mark.parametrize("away", [15.0, 60.0])
def test_half_of_the_light_is_emitted_within_the_depth_of_a_front(away):
    ahead = np.zeros((1, 30, 3))
    ahead[..., 0], ahead[..., 1] = np.linspace(-0.2, 0.2, 30), 1.0
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    rays = Rays(np.array([0.0, 0.0, 0.8]), ahead, np.zeros((1, 30)), None)
    found = flame_distance.measure(line(away), rays, 200.0, 1.0).distance * ahead[..., 1]
    burning = found[found > 0.0]
    assert burning.size > 0.7 * found.size  # others see through gaps
    assert np.all((burning > 0.9 * away - 1.0) & (burning < 1.1 * away + 8.0))
    assert flame_distance.measure(line(away), rays, 200.0, 1.0e6).distance.max() == 0.0


def rays_ahead(width=32, height=4):
    """Rays to the north over level ground from its height of 0.8 m; some go slightly up."""
    ahead = np.ones((height, width, 3))
    ahead[..., 0], ahead[..., 2] = np.linspace(-0.2, 0.2, width), np.linspace(0.03, 0.0, height)[:, None]
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    return Rays(np.array([0.0, 0.0, 0.8]), ahead, np.zeros((height, width)), None)


def dense(found, rays):
    """Distance of half of the light by a march to 1000 distances, m."""
    at = np.geomspace(5.0, 100.0, 1000).astype(np.float32)
    flat = rays.directions.reshape(-1, 3)
    red = volume.march([], rays.origins, flat, np.broadcast_to(at, (len(flat), 1000)), LIGHT, flames=found)
    return at[(red[..., 0] < 0.5 * red[:, -1:, 0]).sum(axis=1)].reshape(rays.directions.shape[:2])


@pytest.mark.parametrize("away", [20.0, 70.0])
def test_distances_are_exact_however_far_flames_are_drawn(away):
    rays = rays_ahead()
    found = flame_distance.measure(line(away), rays, 12_000.0, 1.0).distance
    exact = dense(line(away), rays)
    lit = (found > 0.0) & (exact > 0.5 * away)  # others see through gaps
    error = np.abs(found - exact)[lit]
    assert lit.mean() > 0.8
    assert np.median(error) < 0.005 * away
    assert np.percentile(error, 95) < 0.06 * away


def test_each_part_of_a_picture_has_its_own_range():
    steps = front(6.0, half=(8.0, 18.0), DISTANCE=lambda x, y: y - np.where(x < 0.0, 24.0, 74.0), NORTH=-1.0)
    both = flames(steps)
    rays = rays_ahead(64)
    error = np.abs(flame_distance.measure(both, rays, 12_000.0, 1.0).distance - dense(both, rays))
    assert np.median(error[:, :28]) < 0.15
    assert np.median(error[:, 36:]) < 0.4


def test_cells_that_show_flames_are_lit_and_those_far_from_them_are_not():
    rays = rays_ahead(64)
    few = flames(
        front(6.0, half=(8.0, 18.0), DISTANCE=lambda x, y: np.where(x < 0.0, y - 24.0, -50.0), NORTH=-1.0)
    )
    lit = flame_distance.measure(few, rays, 12_000.0, 1.0).lit
    ends = np.full((lit.size, 1), 100.0, np.float32)
    red = volume.march([], rays.origins, rays.directions.reshape(-1, 3), ends, LIGHT, flames=few)[:, 0, 0]
    assert lit[red.reshape(lit.shape) > 0.0].all()
    assert 0.3 < lit.mean() < 0.7


@pytest.mark.parametrize(("height", "hidden"), [(0.0, False), (40.0, True)])
def test_a_ridge_of_burning_ground_hides_the_flames_behind_it(height, hidden):
    def ridge(x, y):
        return height * np.exp(-(((y - 30.0) / 8.0) ** 2))

    steps = front(
        6.0, half=(8.0, 18.0), DISTANCE=lambda x, y: y - 74.0, NORTH=-1.0, GROUND=ridge, LOW=lambda x, y: 0.3
    )
    distance = flame_distance.measure(flames(steps), rays_ahead(), 12_000.0, 1.0).distance
    assert (distance[2:] > 60.0).any() != hidden


def test_a_cell_is_repeated_for_the_pixels_of_an_odd_picture():
    cells = np.arange(4, dtype=np.float32).reshape(2, 2)
    assert flame_distance.of_pixels(cells, 3, 3).tolist() == [[0, 0, 1], [0, 0, 1], [2, 2, 3]]
