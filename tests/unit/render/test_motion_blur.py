"""Motion blur of a moving camera: the ways of a picture's points during an exposure."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.render import motion_blur
from hypothesis import given
from hypothesis import strategies as st

WIDTH, HEIGHT, HALF = 64, 36, (0.5, 0.28125)
FRAMES = 5


def camera(step=(0.0, 0.0, 0.0), turn=0.0, perspective=True):
    """A camera that looks along -z, moves by `step` m and turns by `turn` radians about y in a frame."""
    angle = turn * np.arange(FRAMES)
    none, one = np.zeros(FRAMES), np.ones(FRAMES)
    rows = [[np.cos(angle), none, np.sin(angle)], [none, one, none], [-np.sin(angle), none, np.cos(angle)]]
    return SimpleNamespace(
        position=np.arange(FRAMES)[:, None] * np.array(step),
        rotation=np.moveaxis(np.array(rows), -1, 0),
        halves=np.tile(HALF, (FRAMES, 1)),
        perspective=perspective,
        around=False,
    )


def point(distance=1000.0):
    """A picture with one bright pixel in its middle, and its distances."""
    picture = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    picture[HEIGHT // 2, WIDTH // 2] = 1.0
    return picture, np.full((HEIGHT, WIDTH), distance, np.float32)


def test_a_camera_at_rest_or_without_exposure_changes_nothing():
    picture, distance = point()
    assert motion_blur.blur(picture, distance, camera(), 3, 1.0) is picture
    assert motion_blur.blur(picture, distance, camera(turn=0.1), 3, 0.0) is picture
    assert motion_blur.blur(picture, distance, camera(turn=0.1, perspective=False), 3, 0.5) is picture


@given(st.floats(0.02, 0.1), st.floats(0.2, 1.0))
def test_a_turn_smears_a_point_along_its_way_and_keeps_its_light(turn, exposure):
    picture, distance = point()
    blurred = motion_blur.blur(picture, distance, camera(turn=turn), 3, exposure)
    row, other = blurred[HEIGHT // 2, :, 0], np.delete(blurred[..., 0], HEIGHT // 2, 0)
    assert row.sum() == pytest.approx(1.0, abs=0.1)
    assert other.sum() < 0.1
    across = np.arange(WIDTH)
    assert np.sum(row * across) / row.sum() == pytest.approx(WIDTH // 2, abs=0.3)
    length = turn * exposure / HALF[0] * 0.5 * WIDTH
    assert np.ptp(across[row > 1e-6]) == pytest.approx(length, abs=3.0)


def test_near_points_of_a_moving_camera_smear_and_the_sky_does_not():
    view = camera(step=(10.0, 0.0, 0.0))
    near, far = (motion_blur.blur(*point(distance), view, 3, 1.0) for distance in (100.0, 1e9))
    assert far.max() == pytest.approx(1.0)
    assert near.max() < 0.5


def test_the_pose_between_frames_is_between_their_poses():
    view = camera(step=(8.0, 0.0, 0.0), turn=0.2)
    position, rotation = motion_blur.pose(view, 2.5)
    assert position == pytest.approx([20.0, 0.0, 0.0])
    assert rotation[0, 0] == pytest.approx(np.cos(0.5))
    assert rotation @ rotation.T == pytest.approx(np.eye(3))
    for ends in (-0.5, FRAMES - 0.5):
        assert np.isfinite(motion_blur.pose(view, ends)[1]).all()


def test_hidden_surfaces_move_with_the_smoke():
    surface, clear = np.full((1, 3), 1e9, np.float32), np.array([[1.000001, 0.5, 0.0]], np.float32)
    found = motion_blur.apparent_distance(surface, clear, 1000.0)
    assert found == pytest.approx(np.array([[1e9, 2000.0, 1000.0]]), rel=0.01)
