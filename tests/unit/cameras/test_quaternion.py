"""Quaternions of rotation matrices."""

import numpy as np
import pytest
from firetwin.geometry.quaternion import matrices, quaternions


def test_quaternions_of_all_directions_give_their_matrices_and_do_not_jump():
    turn = np.radians(np.arange(0, 720, 7))
    turns = []
    for a in turn:
        ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(0.7 * a), np.sin(0.7 * a)
        turns.append([[ca, -sa * cb, sa * sb], [sa, ca * cb, -ca * sb], [0.0, sb, cb]])
    q = quaternions(np.array(turns))
    assert matrices(q) == pytest.approx(np.array(turns), abs=1e-12)
    assert (np.sum(q[1:] * q[:-1], axis=1) > 0.9).all()
