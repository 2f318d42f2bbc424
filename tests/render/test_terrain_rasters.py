"""The user's rasters in the scene: objects on an elevation model, and colours of an orthophoto."""

from dataclasses import replace

import numpy as np
from firetwin.scene import build
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor

PHOTO = (-120.597, 38.803, -120.548, 38.877)  # west, south, east, north


def test_the_photo_is_the_colour_of_unburned_ground(settings, run, scene, shoot, tmp_path):
    red = np.broadcast_to((0.8, 0.05, 0.05), (8, 8, 3))
    sensor.write_image(tmp_path / "photo.png", red)
    changed = replace(
        settings,
        forest=replace(settings.forest, trees=False, grass=False),
        fire=replace(settings.fire, flames=False, embers=False, firebrands=0, torches=False),
        light=replace(settings.light, lamps=0),
        cameras=(Camera("above", Satellite(swath=11_000.0)),),
        render=replace(settings.render, resolution=(64, 64)),
    )
    pictures = []
    for photo in (None, tmp_path / "photo.png"):
        own = replace(changed.terrain, photo=photo, photo_extent=PHOTO if photo else ())
        shot = Shot(replace(changed, terrain=own), run)
        built = build.build(shot, scene)
        built.render.resolution_x = built.render.resolution_y = 64
        built.frame_set(3)
        pictures.append(shoot(built, "rgb"))
    step = (np.arange(64) + 0.5) / 64 * 11_000.0 - 5500.0
    east, north = (v.ravel() for v in np.meshgrid(step, -step))
    latitude, longitude = (v.reshape(64, 64) for v in shot.ground.geodetic(east, north))
    away = np.minimum(
        np.minimum(longitude - PHOTO[0], PHOTO[2] - longitude) * 86_700.0,
        np.minimum(latitude - PHOTO[1], PHOTO[3] - latitude) * 111_000.0,
    )
    arrival = shot.ground.sample(np.minimum(shot.ground.burn_time, 1e8), east, north).reshape(64, 64)
    water_free = shot.ground.sample(shot.ground.water, east, north).reshape(64, 64) == 0.0
    unburned = (arrival > shot.frames.times[-1] + 1500.0) & water_free
    plain, coloured = pictures
    inside, outside = unburned & (away > 500.0), away < -400.0
    assert inside.sum() > 50
    ratio = coloured[inside][:, 0] / coloured[inside][:, 1:].max(axis=1)
    assert np.median(ratio) > 4.0
    assert (plain[inside][:, 0] / plain[inside][:, 1]).max() < 3.0
    assert np.abs(coloured - plain)[outside].max() < 0.02 * plain.max()
    charred = (arrival < shot.frames.times[-1] - 1500.0) & (away > 400.0)
    assert charred.sum() > 20
    assert np.median(np.abs(coloured - plain)[charred]) < 0.01 * np.median(coloured[inside][:, 0])
