"""A reordered mesh is the same mesh: the same triangles with the same orientation."""

import numpy as np
from firetwin.export import mesh_order


def grid(side):
    """Return the places (n, 2) of a shuffled square grid, and its triangles."""
    at = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2) / side
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + side + 1], axis=-1)
    upper = np.stack([corner, corner + side + 1, corner + side], axis=-1)
    random = np.random.default_rng(1)
    place = random.permutation(side * side)
    shuffled = np.empty_like(at)
    shuffled[place] = at
    return shuffled, random.permutation(place[np.concatenate([lower, upper])])


def corners(place, triangles):
    """Return the corners of the triangles, each from its lowest corner on, as a set."""
    found = place[triangles]
    first = np.lexsort(found.transpose(2, 0, 1)[::-1], axis=-1)[:, 0]
    turned = np.take_along_axis(found, (first[:, None] + np.arange(3))[..., None] % 3, axis=1)
    return {tuple(each) for each in turned.reshape(len(triangles), -1).tolist()}


def test_triangles_keep_their_corners_and_their_orientation():
    place, triangles = grid(9)
    order = mesh_order.along_curve(place)
    assert corners(place[order], mesh_order.reorder(triangles, order)) == corners(place, triangles)


def test_neighbours_on_the_ground_are_neighbours_in_the_list():
    place, triangles = grid(32)
    order = mesh_order.along_curve(place)
    before, after = np.ptp(triangles, axis=1), np.ptp(mesh_order.reorder(triangles, order), axis=1)
    assert np.median(after) < 0.1 * np.median(before)


def test_the_curve_visits_the_four_quarters_one_after_the_other():
    at = np.array([(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)])
    assert mesh_order.along_curve(at).tolist() == [0, 2, 3, 1]
