"""Live forest: trees of the film in few meshes, by budget, with the fire's effect on each vertex."""

import bpy
import numpy as np
import pytest
from firetwin.scene.forest import models
from firetwin.scene.live import forest, trees
from live_scene import *  # noqa: F403


def values(data, name, key, width):
    found = np.empty(width * len(data.vertices), np.float32)
    data.attributes[name].data.foreach_get(key, found)
    return found.reshape(-1, width)


def live_trees():
    return [obj for obj in bpy.data.objects if obj.name.startswith("Firetwin Live Trees")]


@pytest.mark.parametrize("budget", [-50, 400, 4000, 10**6])
def test_a_budget_keeps_the_nearest_trees_and_makes_the_nearest_fine(budget):
    away = np.random.default_rng(1).uniform(50.0, 5000.0, 1000)
    kept, near = forest.choose(away, budget)
    assert len(kept) == min(1000, max(budget, 0) // 4)
    assert 4 * len(kept) + 20 * near.sum() <= max(budget, 0)
    assert away[kept].max(initial=0.0) <= np.delete(away, kept).min(initial=np.inf)
    assert away[near].max(initial=0.0) <= away[~near].min(initial=np.inf)
    assert near.all() == (budget == 10**6)


@pytest.mark.parametrize("model", [0, 5, 8, 10])
def test_far_trees_are_as_high_and_wide_as_near_ones(model):
    near, far = trees.near(model), trees.far(model)
    assert len(far.triangles) == 4
    assert len(near.triangles) <= 40
    assert far.points[:, 2].max() == pytest.approx(near.points[near.leaf > 0.5, 2].max())
    width = np.hypot(*near.points[near.leaf > 0.5, :2].T)
    assert np.percentile(width, 50) < np.abs(far.points[:, 0]).max() < 1.2 * width.max()
    mean = near.colours[near.leaf > 0.5].mean(axis=0)
    np.testing.assert_allclose(far.colours, np.tile(mean, (6, 1)))


def test_snags_have_sheets_without_leaves():
    assert trees.far(models.SNAGS[0]).leaf.max() == 0.0


def test_trees_of_the_film_stand_in_few_meshes(live_stage):
    film = bpy.data.objects["Firetwin Trees"].data
    place = np.empty(3 * len(film.vertices), np.float32)
    film.vertices.foreach_get("co", place)
    place = place.reshape(-1, 3)
    wide = np.ones(len(place), np.float32)
    for name in ("scale", "width"):
        factor = np.empty_like(wide)
        film.attributes[name].data.foreach_get("value", factor)
        wide *= factor
    found = live_trees()
    assert 1 < len(found) <= 16
    for obj in found:
        position = np.empty(3 * len(obj.data.vertices), np.float32)
        obj.data.vertices.foreach_get("co", position)
        away = np.linalg.norm(position.reshape(-1, 1, 3)[..., :2] - place[None, :, :2], axis=-1)
        assert (away / wide).min(axis=1).max() < 0.8  # within the crown of a tree of the film


def test_each_vertex_knows_when_and_how_its_tree_burns(live_stage):
    effects = []
    for obj in live_trees():
        arrival, effect, high = values(obj.data, "fire", "vector", 3).T
        effects.append(effect)
        assert arrival.min() > -3600.0
        assert high.max() <= 1.01
        leaf = values(obj.data, "leaf", "color", 4)
        assert set(np.round(leaf[:, 3], 3)) <= {0.0, 1.0}
        outward = values(obj.data, "outward", "vector", 3)
        np.testing.assert_allclose(np.linalg.norm(outward, axis=1), 1.0, atol=1e-3)
    effect = np.concatenate(effects)
    assert (effect == 2.0).any()
    assert (((effect >= 0.0) & (effect <= 1.0)) | (effect == 2.0)).all()
