"""The camera for headsets in Cycles: views of both eyes, and metadata of the files."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.jobs import render_blend
from firetwin.render import engine, layers
from firetwin.render.picture import Picture
from firetwin.scene.camera import build as cameras
from firetwin.scene.terrain import build as ground
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.vr import Vr
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor

SIZE, FRAME, APART = 256, 2, 60.0
PIXEL = 2.0 * np.pi / SIZE


def test_depth_pose_and_terrain_agree_in_both_eyes_and_near_things_shift_the_right_way(
    settings, run, stage, scene, tmp_path
):
    keys = (CameraKey(0.0, 38.83, -120.56, 300.0, "fire"), CameraKey(1.0, 38.84, -120.55, 300.0, "fire"))
    render = replace(settings.render, resolution=(SIZE, SIZE), passes=("depth",))
    shot = Shot(replace(settings, cameras=(Camera("vr", Vr(APART, keys=keys)),), render=render), run)
    ground.build(shot, stage, None)
    (scene.camera,) = cameras.build(shot, stage)
    (view,) = shot.paths
    turn = view.rotation[FRAME - 1]
    bpy.ops.mesh.primitive_uv_sphere_add(radius=15.0, location=view.position[FRAME - 1] - 200.0 * turn[:, 2])
    layers.build(shot.settings, stage)
    engine.apply(shot.settings, scene)
    layers.select(scene, ["depth"])
    scene.frame_set(FRAME)
    picture = Picture("vr", FRAME, "depth")
    layers.write_exr(scene, str(tmp_path), [picture])
    with engine.pixel_centres(scene):
        bpy.ops.render.render(scene=scene.name)
    depth = np.asarray(sensor.read_image(tmp_path / f"{picture.stem()}{FRAME:06d}.exr"))[..., 0]
    assert depth.shape == (SIZE, SIZE)

    # The ball ahead: the left eye, above, sees it to the right, and the right one to the left.
    row, column = np.nonzero(depth < 201.0)
    above = row < SIZE // 2
    assert (depth[row, column] > 184.0).all()
    shift = np.degrees((column + 0.5 - SIZE / 2) * PIXEL)
    expected = float(np.degrees(np.arcsin(0.5 * APART / 200.0)))
    assert shift[above].mean() == pytest.approx(expected, abs=0.5)
    assert shift[~above].mean() == pytest.approx(-expected, abs=0.5)
    level = np.array([row[above].mean(), row[~above].mean()])
    assert level + 0.5 == pytest.approx([SIZE / 4, 3 * SIZE / 4], abs=0.5)  # the horizon, straight ahead

    # The ground: where depth and pose say that it is.
    place = pixel_rays.points(view, FRAME, depth)
    seen = (depth > 220.0) & (np.abs(place[..., :2]).max(axis=-1) < 4000.0)
    earth = place.copy()
    earth[..., 2] = shot.ground.up(*(np.nan_to_num(place[..., k]).ravel() for k in (0, 1))).reshape(SIZE, -1)
    bearing = ((np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0) * np.pi
    side = np.where(np.arange(SIZE)[:, None] < SIZE // 2, -0.5, 0.5) * APART
    right = np.cos(bearing)[:, None] * turn[:, 0] + np.sin(bearing)[:, None] * turn[:, 2]
    low = np.abs(np.tile((np.arange(SIZE // 2) + 0.5) / SIZE * 2.0 * np.pi - 0.5 * np.pi, 2)) < np.pi / 3
    for half in (above_half := slice(None, SIZE // 2), slice(SIZE // 2, None)):
        here = seen[half] & low[half, None]  # where the eyes are as far apart as they can be
        assert here.sum() > 5000, half == above_half
        eye = view.position[FRAME - 1] + (side[half, :, None] * right)
        a, b = (points[half] - eye for points in (place, earth))
        angle = np.linalg.norm(np.cross(a, b), axis=-1) / np.sum(a * b, axis=-1)
        off = (angle / PIXEL)[here]
        print(f"99 of 100 within {np.percentile(off, 99):.3f} pixels, all within {off.max():.3f}")
        assert np.percentile(off, 99) < 0.4  # 0.5 without eyes, 0.8 with the wrong ones
        local = a @ turn  # each line of sight ends where its pixel is
        across = np.arctan2(local[..., 0], -local[..., 2]) - bearing
        assert np.abs((across + np.pi) % (2.0 * np.pi) - np.pi)[here].max() < 0.01 * PIXEL

    # All round: at the back the picture goes on from its right end at its left one.
    steps = np.abs(np.diff(np.log(depth), axis=1, append=np.log(depth[:, :1])))[seen[:, -1] & seen[:, 0]]
    beside = steps[:, [-4, -3, -2, 0, 1, 2]]  # the same slope of the ground
    assert np.median(steps[:, -1]) < 2.0 * np.median(beside)


def test_a_scene_as_it_stands_keeps_both_eyes_and_their_size(settings, run, scene):
    render = replace(settings.render, resolution=(SIZE, SIZE))
    vr = Camera("vr", Vr(APART, keys=(CameraKey(0.0, 38.83, -120.56, 300.0, "fire"),)))
    shot = Shot(replace(settings, cameras=(vr,), render=render), run)
    engine.apply(shot.settings, scene)
    for percent, across in ((100, SIZE), (50, SIZE // 2)):
        scene.render.resolution_percentage = percent
        stands = render_blend._with_scene_settings(shot, scene)
        assert stands.settings.render.resolution == (across, across)
        engine.set_resolution(stands.settings, scene)
        size = scene.render.resolution_x, scene.render.resolution_y, scene.render.use_multiview
        assert size == (across, across // 2, True)  # of each eye
