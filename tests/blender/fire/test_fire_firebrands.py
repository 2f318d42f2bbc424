"""Firebrands: launched by the flames, flown by the core, drawn by geometry nodes at any time."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.run import burning
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import firebrands, flames
from firetwin.shot.sections import FireSettings
from firetwin.shot.shot import Shot
from near_fire import FRAMES, moved


def flown(shot):
    return firebrands.fly(shot, flames.front_flames(shot))


def drawn(scene, frame, subframe=0.0):
    """Places, sizes and directions of the streaks in a frame, in order."""
    scene.frame_set(frame, subframe=subframe)
    graph = bpy.context.evaluated_depsgraph_get()
    thing = bpy.data.objects["Firetwin Firebrands"].evaluated_get(graph)
    found = [i.matrix_world.copy() for i in graph.object_instances if i.is_instance and i.parent == thing]
    place = np.array([m.translation[:] for m in found]).reshape(-1, 3)
    axis = np.array([m.to_3x3().normalized().col[2][:] for m in found]).reshape(-1, 3)
    return place, axis, np.array([m.to_scale()[:] for m in found]).reshape(-1, 3)


def sorted_rows(rows):
    return rows[np.lexsort(rows.T)]


def look(scene):
    camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(camera)
    scene.camera = camera


def test_pieces_fly_over_the_ground_and_move_with_the_wind(close, run, monkeypatch):
    monkeypatch.setattr(burning, "wind_at", lambda run, times, within: np.tile((8.0, 0.0), (len(times), 1)))
    shot = Shot(close, run)
    found, ground = flown(shot), shot.ground
    assert len(found.life) > 100
    place = found.place.astype(np.float64)
    height = place[..., 2] - ground.up(*place[..., :2].reshape(-1, 2).T).reshape(place.shape[:2])
    assert height.min() > -3.0  # they land on a grid coarser than the ground
    assert height.max() > 15.0
    moved = place[:, 8] - place[:, 0]
    assert 2.0 < np.median(moved[:, 0]) / 4.0 < 12.0
    assert abs(np.median(moved[:, 1])) < 4.0


def test_their_number_follows_the_intensity(close, run):
    """Twice the heat throws up twice as many."""
    many = Shot(replace(close, fire=replace(close.fire, firebrands=100_000)), run)
    points = flames.front_flames(many)
    counts = [
        len(firebrands.fly(many, replace(points, intensity=factor * points.intensity)).life)
        for factor in (0.5, 1.0)
    ]
    assert counts[1] / counts[0] == pytest.approx(2.0, rel=0.1)


def test_no_frame_shows_more_than_the_budget(close, run):
    few = replace(close, fire=replace(close.fire, firebrands=40))
    found = flown(Shot(few, run))
    counts = [len(found.alive(frame / (FRAMES - 1))) for frame in range(FRAMES)]
    assert 20 < max(counts) <= 40


def test_the_same_twice_and_other_with_another_seed(close, run):
    first, again = (flown(Shot(close, run)) for _ in range(2))
    assert np.array_equal(first.place, again.place)
    other = flown(Shot(replace(close, seed=2), run))
    assert first.place.shape != other.place.shape or not np.array_equal(first.place, other.place)


def test_blender_draws_those_alive_where_their_path_is(close, run, stage, scene):
    scene.frame_end = FRAMES
    shot = Shot(close, run)
    fire.build(shot, stage)
    look(scene)
    firebrands = flown(shot)
    for frame, subframe in ((1, 0.0), (12, 0.5), (24, 0.0)):
        time = (frame + subframe - 1.0) / (FRAMES - 1)
        alive = firebrands.alive(time)
        at = (time - firebrands.start[alive]) / firebrands.step
        low = np.clip(np.floor(at).astype(int), 0, firebrands.place.shape[1] - 2)
        part = (at - low)[:, None]
        wanted = firebrands.place[alive, low] * (1.0 - part) + firebrands.place[alive, low + 1] * part
        place, axis, size = drawn(scene, frame, subframe)
        assert len(place) == pytest.approx(len(alive), abs=2)
        gap = np.linalg.norm(place[:, None] - wanted[None], axis=-1).min(axis=1)
        assert np.percentile(gap, 98.0) < 0.05
        assert np.all(size[:, 2] >= size[:, 0])
        steps = np.diff(firebrands.place[alive], axis=1)[np.arange(len(alive)), low]
        moves = np.linalg.norm(steps, axis=-1) / firebrands.step / 48.0  # in the exposure time
        nearest = np.linalg.norm(place[:, None] - wanted[None], axis=-1).argmin(axis=1)
        wrong = np.abs(size[:, 2] - size[:, 0] - moves[nearest])
        assert np.percentile(wrong, 98.0) < 0.01
        assert np.linalg.norm(axis, axis=1) == pytest.approx(1.0, abs=1e-3)


def test_streaks_last_as_long_as_the_exposure_of_motion_blur(close, run):
    def exposure(blur):
        return firebrands.exposure_time(
            Shot(replace(close, render=replace(close.render, motion_blur=blur)), run)
        )

    step = 1.0 / (FRAMES - 1)
    assert [exposure(blur) for blur in (0.0, 0.25, 1.0)] == pytest.approx([1.0 / 48.0, 0.25 * step, step])


def test_a_saved_scene_scrubs_without_the_add_on(close, run, stage, scene, tmp_path):
    scene.frame_end = FRAMES
    fire.build(Shot(close, run), stage)
    look(scene)
    early, late = drawn(scene, 1)[0], drawn(scene, 24)[0]
    assert not np.array_equal(sorted_rows(early), sorted_rows(late))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert not bpy.app.handlers.frame_change_pre
    assert not bpy.app.handlers.frame_change_post
    assert not any(d.animation_data and d.animation_data.drivers for d in bpy.data.objects)
    back = bpy.context.scene
    assert np.array_equal(sorted_rows(drawn(back, 24)[0]), sorted_rows(late))
    assert np.array_equal(sorted_rows(drawn(back, 1)[0]), sorted_rows(early))


def test_frames_far_apart_show_the_pieces_of_their_own_moment(settings, run, stage, scene):
    """Frames half an hour apart: whoever flies in one is long gone in the next."""
    shot = Shot(moved(settings, latitude=38.8395, height=150.0), run)
    scene.frame_end = 3
    fire.build(shot, stage)
    look(scene)
    place, _, _ = drawn(scene, 2)
    assert len(place) > 50
    assert len(drawn(scene, 2, 0.5)[0]) == 0
    points = flames.front_flames(shot)
    lit = points.position[points.lit(float(shot.frames.times[1]))]
    gap = np.linalg.norm(place[:, None] - lit[None], axis=-1).min(axis=1)
    assert np.median(gap) < 120.0


def test_a_camera_far_away_sees_none(close, run, stage, scene):
    """Else hundreds of streaks, each as wide as the satellite's pixels, lie one over the other."""
    shot = Shot(close, run)
    fire.build(shot, stage)
    look(scene)
    scene.camera.location = shot.paths[0].position[0]
    assert len(drawn(scene, 12)[0]) > 50
    scene.camera.location.z += 60_000.0
    assert len(drawn(scene, 12)[0]) == 0


def test_twice_built_is_built_once_and_none_out_of_reach(close, run, stage):
    fire.build(Shot(close, run), stage)
    count = len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.node_groups), len(bpy.data.materials)
    fire.build(Shot(close, run), stage)
    assert count == (
        len(bpy.data.objects),
        len(bpy.data.meshes),
        len(bpy.data.node_groups),
        len(bpy.data.materials),
    )
    fire.build(Shot(moved(close, latitude=38.7, longitude=-120.6), run), stage)
    assert "Firetwin Firebrands" not in bpy.data.objects
    fire.build(Shot(replace(close, fire=FireSettings(firebrands=0)), run), stage)
    assert "Firetwin Firebrands" not in bpy.data.objects
