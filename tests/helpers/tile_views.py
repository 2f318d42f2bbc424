"""Random views of a shot, and screen-space errors by every one of them, without a tree of views."""

import numpy as np
from firetwin.tiles import cut
from firetwin.tiles.cut import Views
from firetwin_core import lod
from scipy.optimize import nnls

HERE = np.eye(4)


def looking(x, height=1080, half=0.5, y=0.0):
    """One view along x, from (x, y, 0)."""
    rotation = np.array([[0.0, 0, -1], [-1, 0, 0], [0, 1, 0]])
    views = lod.ViewSet([[x, y, 0]], rotation, [half, half])
    return Views(views, cut.pixels([height], half), np.array([[x, y, 0.0]]))


def names(loader, choice):
    """Contents of a choice as their tilesets name them."""
    return [loader.tree.reference(k) for k in choice.contents]


def random_views(rng, count):
    """Positions, rotations, halves, whether parallel, and pixels of views; neighbours are similar."""
    position = rng.normal(0, 30, 3) + np.cumsum(rng.normal(0, 2, (count, 3)), axis=0)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn[:, 0] *= np.linalg.det(turn)
    rotation = np.empty((count, 3, 3))
    for i in range(count):
        a = rng.normal(0, 0.1)
        turn = turn @ np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
        rotation[i] = turn
    if rng.random() < 0.3:
        position[:], rotation[:] = position[0], rotation[0]  # a camera that only zooms
    parallel = np.full(count, rng.random() < 0.2) ^ (rng.random(count) < 0.1)
    half = np.where(parallel[:, None], rng.uniform(5, 40, (count, 2)), rng.uniform(0.1, 1.0, (count, 2)))
    return position, rotation, half, parallel, rng.uniform(50, 900, count)


def view_set(views):
    """The core's views."""
    position, rotation, half, parallel, _ = views
    return lod.ViewSet(position, rotation, half, orthographic=parallel, above_terrain=False)


def planes(half, parallel):
    """Inward normals (5, 3) of a view's planes in its own axes, and how far they lie behind the camera."""
    half_spaces = [((0.0, 0.0, -1.0), 0.0)]
    for axis in range(2):
        for sign in (1.0, -1.0):
            normal = np.array([0.0, 0.0, 0.0 if parallel else -half[axis]])
            normal[axis] = sign
            half_spaces.append((normal / np.linalg.norm(normal), half[axis] if parallel else 0.0))
    return np.array([normal for normal, _ in half_spaces]), np.array([offset for _, offset in half_spaces])


def outside(place, normal, offset):
    """Distance of a place, in a view's axes, from the view volume."""
    if offset.any():
        return np.linalg.norm(np.minimum([(place @ normal.T + offset)[k : k + 2].min() for k in (1, 3)], 0))
    # Moreau: the remainder of a projection on a cone is in the cone of its outward normals.
    outward = -normal.T
    return np.linalg.norm(outward @ nnls(outward, place)[0])


def errors(volumes, error, views):
    """Largest errors (n,) over views, as if each view saw the least and the most that it may.

    The least: spheres that reach into the view volume. The most: spheres that reach over each of its planes,
    as some outside of its edges do.
    """
    centre, axis, half, extra = volumes
    radius = np.linalg.norm(half, axis=1) + extra
    least, most = np.full((2, len(error)), -1.0)
    for position, rotation, halves, parallel, pixels in zip(*views, strict=True):
        to = centre - position
        normal, offset = planes(halves, parallel)
        local = to @ rotation
        passes = (local @ normal.T + offset + radius[:, None] >= -1e-9).all(axis=1)
        beyond = np.maximum(np.abs(np.einsum("nki,ni->nk", axis, -to)) - half, 0)
        distance = np.maximum(np.linalg.norm(beyond, axis=1) - extra, 0)
        size = error * pixels if parallel else error * pixels / np.maximum(distance, 1e-7)
        most = np.where(passes, np.maximum(most, size), most)
        for i in np.flatnonzero(passes):
            if local[i, 2] <= radius[i] and outside(local[i], normal, offset) <= radius[i] - 1e-9:
                least[i] = max(least[i], size[i])
    return least, most
