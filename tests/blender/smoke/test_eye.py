"""Smoke directly in front of the camera, and the warning of a camera in smoke."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.render import eye, integrated
from firetwin.render.rays import Rays
from firetwin.scene.smoke import illumination
from firetwin_core import volume

SHAPE = 64, 96


@pytest.fixture
def looking(monkeypatch):
    """An eye at a place (m) that looks along x; smoke of 0.1 /m fills 400 m from the origin on, y below 0."""
    monkeypatch.setattr(illumination, "extinction_factor", lambda stage: 1.0)
    density = np.full((40, 40, 40), 0.1, np.float32)
    ones = np.ones_like(density)
    smoke = [volume.Bricks(density, ones, ones, ones, None, voxel_size=10.0, origin=(0.0, -390.0, -200.0))]

    def make(x, y, smoky=True):
        found = object.__new__(eye.Eye)
        found.stage, found.smoke = None, smoke if smoky else []
        directions = np.broadcast_to([1.0, 0.0, 0.0], (*SHAPE, 3))
        found.rays = Rays(np.array([x, y, 0.0]), directions, np.zeros(SHAPE), None)
        return found

    return make


def test_smoke_right_before_an_eye_hides_its_picture(looking):
    assert looking(100.0, -200.0).hidden_by_near_smoke(100.0) == 1.0
    assert looking(100.0, -200.0).hidden_by_near_smoke(10.0) == 0.0, "10 m of it let a third through"
    assert looking(-500.0, -200.0).hidden_by_near_smoke(100.0) == 0.0, "distant smoke is part of the picture"
    assert looking(100.0, 300.0).hidden_by_near_smoke(100.0) == 0.0
    assert looking(100.0, -200.0, smoky=False).hidden_by_near_smoke(100.0) == 0.0


def test_a_camera_in_smoke_is_told_of(looking):
    renderer = object.__new__(integrated.IntegratedRenderer)
    places = np.array([[100.0, -200.0, 0.0]] * 3)
    view = SimpleNamespace(
        perspective=True,
        position=places,
        target=np.add(places, [1000.0, 0.0, 0.0]),
        camera=SimpleNamespace(name="drone"),
    )
    renderer.in_smoke, renderer.shot = [], SimpleNamespace(paths=[view])
    renderer._check_view(looking(-500.0, -200.0), 1)
    assert renderer.warnings() == []
    renderer._check_view(looking(100.0, -200.0), 2)
    (text,) = renderer.warnings()
    assert text.startswith('camera "drone" is inside smoke')
    assert "in frame 2; move it" in text
    renderer._check_view(looking(100.0, -200.0), 3)
    assert "in 2 frames" in "".join(renderer.warnings())


def test_pixels_of_flames_in_the_infrared_are_means_over_their_area(looking, monkeypatch):
    """Radiance that rises across a pixel gives its mean, and chosen pixels alone are marched."""
    camera_eye = looking(0.0, 300.0)
    camera_eye.shape, camera_eye.distance = SHAPE, np.ones(SHAPE, np.float32)
    plain, at = camera_eye.rays, []

    def through(at_place):
        at.append(at_place)
        return plain

    def march(smoke, origins, directions, ends):
        return np.tile(np.float32(at[-1]), (len(ends), 1))

    camera_eye._through = lambda at: through(at)
    monkeypatch.setattr(eye.volume, "march_infrared", march)
    chosen = np.zeros(SHAPE, bool)
    chosen[3, 4:9] = True
    mean = camera_eye._march_infrared([], chosen, eye._FINER_PLACES, {})
    assert mean == pytest.approx(np.full((5, 2), 0.5), abs=1e-6)
    assert [len({place[axis] for place in at}) for axis in (0, 1)] == 2 * [len(eye._FINER_PLACES)]
