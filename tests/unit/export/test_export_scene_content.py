"""Content of exports: burned plants, lit flames, and normals of crowns."""

import numpy as np
import pytest
from firetwin.export.scene_content import FlamePoints, Prototype


@pytest.fixture
def prototype():
    """Two leaves on opposite sides of a trunk, and a piece of its bark."""
    leaf, east = np.array([(0.0, 0.0, 0.5), (0.0, 0.1, 0.5), (0.1, 0.0, 0.5)]), np.array((0.3, 0.0, 0.0))
    points = np.concatenate([leaf + east, leaf - 1.5 * east, leaf[:, [2, 0, 1]]])
    triangles, looks = np.arange(9).reshape(3, 3), np.array([0, 0, 1])
    return Prototype("x", "large", "living", 0, points, triangles, np.zeros((3, 3)), looks)


def test_leaves_face_away_from_the_trunk_and_bark_does_not(prototype):
    right, left, bark = prototype.shading_normals()
    assert right[0] > 0.5
    assert left[0] < -0.5
    np.testing.assert_allclose(np.linalg.norm([right, left], axis=1), 1.0, rtol=1e-6)
    assert sorted(np.abs(bark).tolist()) == [0.0, 0.0, 1.0]


def test_a_flame_is_lit_from_its_arrival_for_its_residence():
    arrival, residence, zero = np.array([0.0, 10.0]), np.array([10.0, 5.0]), np.zeros(2)
    flames = FlamePoints(np.zeros((2, 3)), arrival, residence, *[zero] * 6, wind=(1.0, 0.0))
    assert [flames.lit(time).tolist() for time in (-1.0, 0.0, 9.9, 10.0, 15.0)] == [[], [0], [0], [1], []]
