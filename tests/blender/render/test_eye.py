"""Infrared smoke of an eye: few rays where surfaces are even, one in each pixel at their edges."""

import numpy as np
import pytest
from firetwin.render.eye import Eye

SIZE = 33, 40


@pytest.fixture
def eye(monkeypatch):
    """Eye of a plane with a step, whose infrared rays meet a linear field."""
    plane = object.__new__(Eye)
    plane.shape, plane.smoke, plane.rays_marched = SIZE, [], 0
    distance = np.full(SIZE, 100.0, np.float32)
    distance[:, 20:] = 120.0
    plane.__dict__["distance"] = distance

    def march(smoke, chosen, places, air):
        plane.rays_marched += int(chosen.sum()) * len(places)
        row, column = np.nonzero(chosen)
        return np.stack([2.0 * row + 3.0 * column, 1.0 - 0.01 * row], axis=-1).astype(np.float32)

    monkeypatch.setattr(plane, "_march_infrared", march)
    return plane


def test_a_quarter_of_the_rays_give_a_linear_field(eye):
    light, through = np.moveaxis(eye._interpolated(np.ones(SIZE, bool), {}), -1, 0)
    row, column = np.mgrid[: SIZE[0], : SIZE[1]]
    assert light == pytest.approx(2.0 * row + 3.0 * column, abs=1e-3)
    assert through == pytest.approx(1.0 - 0.01 * row, abs=1e-6)
    assert eye.rays_marched < 0.3 * SIZE[0] * SIZE[1]


def test_pixels_at_the_edge_of_a_surface_have_rays_of_their_own(eye):
    even = eye._is_even
    assert even[:, :18].all()
    assert not even[:, 18:22].any()
    assert even[:, 22:].all()
