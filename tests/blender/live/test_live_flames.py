"""Live flames: sheets at the film's points, of which a shader shows those that burn."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene.fire import flames as film
from firetwin.scene.live import flames
from live_scene import *  # noqa: F403


def values(name):
    data = bpy.data.objects["Firetwin Live Flames"].data
    found = np.empty(3 * len(data.vertices), np.float32)
    data.attributes[name].data.foreach_get("vector", found)
    return found.reshape(-1, 2, 4, 3)


@pytest.mark.parametrize("count", [10, 99, 1000])
def test_near_flames_are_kept_and_far_ones_thinned(count):
    away = np.random.default_rng(2).permutation(500).astype(float)
    kept = flames.choose(away, count)
    assert len(set(kept)) == len(kept) <= count
    assert len(kept) >= min(count, 500) * 0.75
    near = np.argsort(away)[: min(count, 500) // 2]
    assert set(near) <= set(kept)
    assert away[kept].max() > 400.0


def test_sheets_stand_at_points_of_the_film_and_burn_with_them(live_stage):
    points = bpy.data.objects["Firetwin Flames"].data
    place = np.empty(3 * len(points.vertices), np.float32)
    points.vertices.foreach_get("co", place)
    arrival = np.empty(len(points.vertices), np.float32)
    points.attributes["arrival_time"].data.foreach_get("value", arrival)
    corners, burn = values("position"), values("burn")
    foot = corners[:, 0, :2].mean(axis=1)
    away = np.linalg.norm(foot[:, None] - place.reshape(1, -1, 3), axis=-1)
    assert away.min(axis=1).max() < 0.01
    np.testing.assert_allclose(burn[:, 0, 0, 0], arrival[away.argmin(axis=1)], atol=0.01)
    assert (burn == burn[:, :1, :1]).all()


def test_sheets_are_as_long_as_the_flames_and_cross(live_stage):
    corners, burn = values("position"), values("burn")
    length = np.linalg.norm(corners[:, :, 3] - corners[:, :, 0], axis=-1)
    np.testing.assert_allclose(length, burn[:, :, 0, 2], rtol=1e-3)
    side = corners[:, :, 1] - corners[:, :, 0]
    assert np.abs(np.sum(side[:, 0] * side[:, 1], axis=-1)).max() < 1e-2
    card = values("card")
    assert (card[:, :, :2, 1] == 0.0).all()
    assert (card[:, :, 2:, 1] == 1.0).all()


def test_they_blend_and_read_the_time_of_the_scene(live_stage):
    assert bpy.data.materials["Firetwin Live Flames"].surface_render_method == "BLENDED"
    group = bpy.data.node_groups["Firetwin Live Flames Shader"]
    assert nodes.TIME in {node.attribute_name for node in group.nodes if node.type == "ATTRIBUTE"}


def test_without_flames_there_is_no_object(shot, stage, monkeypatch):
    monkeypatch.setattr(film, "front_flames", lambda *_: pytest.fail("not asked for"))
    settings = replace(shot.settings, fire=replace(shot.settings.fire, flames=False))
    assert flames.build(shot.with_settings(settings), stage, stage.part("Live"), 1000, None) is None
