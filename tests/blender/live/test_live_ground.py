"""Live ground: fine near the viewers, within its budget; burns by the scene's time alone."""

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene.live import ground, viewers
from live_scene import *  # noqa: F403


def corners(row, column, triangles):
    """Squared sizes of triangles in grid cells, and middles (n, 2)."""
    place = np.stack([row, column], axis=-1)[triangles]
    sides = place - np.roll(place, 1, axis=1)
    return np.square(sides).sum(axis=(1, 2)), place.mean(axis=1)


@pytest.mark.parametrize("budget", [30_000, 8000])
def test_the_mesh_is_within_its_budget_and_finest_near_viewers(near_shot, budget):
    row, column, triangles = ground.shape(near_shot, budget)
    assert 0.25 * budget < len(triangles) <= budget
    size, middle = corners(row, column, triangles)
    place = near_shot.ground.frame.forward(
        *near_shot.ground.places(*middle.T), near_shot.ground.height(*middle.T)
    )
    near = viewers.distance(near_shot, place)
    order = np.argsort(near)
    quarter = len(order) // 4
    assert np.median(size[order[:quarter]]) < np.median(size[order[-quarter:]])


def test_times_are_exact_in_eevee(live_stage):
    """EEVEE's half precision ends at 65,504 s, 18 hours into a run."""
    image = bpy.data.images["Firetwin Live Fire"]
    assert not image.use_half_precision
    pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(pixels)
    arrival, burned = pixels.reshape(-1, 4)[:, :2].T
    assert burned.max() == 1.0
    assert np.ptp(arrival[burned > 0.5]) > 600.0


def test_only_the_time_of_the_scene_moves_the_fire(live_stage):
    """The material reads the scene's time, which an F-curve sets; no handler and no driver is needed."""
    group = bpy.data.node_groups["Firetwin Live Ground Shader"]
    read = {(node.attribute_name, node.attribute_type) for node in group.nodes if node.type == "ATTRIBUTE"}
    assert (nodes.TIME, "VIEW_LAYER") in read
    live_stage.scene.frame_set(1)
    first = live_stage.scene[nodes.TIME]
    live_stage.scene.frame_set(3)
    assert live_stage.scene[nodes.TIME] == pytest.approx(first + 3600.0)
