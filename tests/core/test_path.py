"""What a camera sees along its path: nothing that a frame shows is left out."""

import numpy as np
import pytest
from firetwin.shot import path
from firetwin.shot.path import Path
from firetwin.shot.settings import Camera
from hypothesis import given, settings
from hypothesis import strategies as st


def _flight(frames: int, turns: float, length: float, seed: int, perspective: bool) -> Path:
    """A winding flight that looks all over."""
    random = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, frames)
    position = length * np.stack([t, np.sin(5 * t), 0.1 * np.cos(9 * t)], axis=-1)
    angle = random.uniform(0, 6) + 2 * np.pi * turns * t
    look = np.stack([np.cos(angle), np.sin(angle), -0.4 - 0.3 * np.sin(3 * angle)], axis=-1)
    target = position + 1000.0 * look
    half = (0.6, 0.35) if perspective else (3000.0, 1500.0)
    return Path(Camera(), position, path.look(position, target), target, half, perspective)


def _seen_in_a_frame(view: Path, points: np.ndarray, margin: float, reach: float) -> np.ndarray:
    """The same asked of every frame, in double precision."""
    seen = np.zeros(len(points), bool)
    for position, rotation in zip(view.position, view.rotation, strict=True):
        local = (points - position) @ rotation
        scale = np.maximum(-local[:, 2], 0.0) if view.perspective else 1.0
        inside = (local[:, 2] < margin) & ((local**2).sum(1) < reach**2)
        for axis in (0, 1):
            inside &= np.abs(local[:, axis]) <= scale * view.half[axis] + margin
        seen |= inside
    return seen


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from([1, 5, 64, 65, 200, 700]),
    st.floats(0, 4),
    st.floats(0, 30_000),
    st.integers(0, 99),
    st.booleans(),
)
def test_nothing_between_the_moments_that_are_asked_is_lost(frames, turns, length, seed, perspective):
    view = _flight(frames, turns, length, seed, perspective)
    points = np.random.default_rng(seed + 1).uniform(-20_000, 40_000, (3000, 3)) * [1, 1, 0.1]
    for margin, reach in ((150.0, np.inf), (60.0, 9000.0)):
        clearly = _seen_in_a_frame(view, points, margin - 1.0, reach - 1.0)  # not on an edge
        assert not (clearly & ~view.sees(points, margin, reach)).any()


def test_a_few_frames_are_asked_exactly():
    view = _flight(40, 1.0, 5000.0, 3, True)
    points = np.random.default_rng(5).uniform(-5000, 9000, (20_000, 3))
    assert (view.sees(points, 100.0) != _seen_in_a_frame(view, points, 100.0, np.inf)).mean() < 1e-4


def test_a_long_shot_of_a_still_camera_is_one_moment():
    view = _flight(1000, 0.0, 0.0, 1, True)
    points = np.random.default_rng(5).uniform(-5000, 9000, (5000, 3))
    one = Path(view.camera, view.position[:1], view.rotation[:1], view.target[:1], view.half)
    assert (view.sees(points) == one.sees(points)).all()


@pytest.mark.parametrize("frames", [10, 500])
def test_distances_are_never_too_long_and_hardly_too_short(frames):
    view = _flight(frames, 1.0, 8000.0, 2, True)
    points = np.random.default_rng(6).uniform(-5000, 9000, (2000, 3))
    true = np.min(np.linalg.norm(points[:, None] - view.position[None], axis=2), axis=1)
    found = view.distance(points)
    assert (found <= true + 0.1).all()
    step = np.linalg.norm(np.diff(view.position, axis=0), axis=1).max()
    assert (found >= true - max(frames / 64, 0) * step - 0.1).all()
