"""The user's own rasters in the scene: what stands on an elevation model, and what an orthophoto colours."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.scene import build
from firetwin.shot.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor

PHOTO = (-120.597, 38.803, -120.548, 38.877)  # west, south, east, north


def plane(latitude, longitude):
    """A hillside unlike the run's, m."""
    return 1500.0 + 4.0e3 * (latitude - 38.84) - 6.0e3 * (longitude + 120.55)


@pytest.fixture
def model(tmp_path):
    """Write an elevation model of the whole run."""
    rasterio = pytest.importorskip("rasterio")
    count, step = 300, 0.0005
    longitude, latitude = np.meshgrid(-120.625 + step * np.arange(count), 38.915 - step * np.arange(count))
    transform = rasterio.Affine(step, 0.0, -120.625 - 0.5 * step, 0.0, -step, 38.915 + 0.5 * step)
    path = tmp_path / "dem.tif"
    with rasterio.open(
        path, "w", driver="GTiff", width=count, height=count, count=1, dtype="float32",
        crs="EPSG:4326", transform=transform,
    ) as file:  # fmt: skip
        file.write(plane(latitude, longitude).astype(np.float32), 1)
    return path


@pytest.mark.parametrize("density", ["paper", "stand"])
def test_trees_and_ground_stand_on_the_elevation_model(near_settings, run, scene, model, density):
    changed = replace(
        near_settings,
        ground=replace(near_settings.ground, elevation=model),
        forest=replace(near_settings.forest, density=density),
    )
    shot = Shot(changed, run)
    build.build(shot, scene, ("ground", "forest"))
    for name, most in (("Ground", 0.3), ("Trees", 0.3)):
        data = next(thing.data for thing in bpy.data.objects if thing.name.endswith(name))
        place = np.empty(3 * len(data.vertices), np.float32)
        data.vertices.foreach_get("co", place)
        place = place.reshape(-1, 3).astype(float)
        place = place[np.abs(place[:, :2]).max(axis=1) < 3500.0]
        assert len(place) > 20
        latitude, longitude, height = shot.local_frame.reverse(place)
        assert height == pytest.approx(plane(latitude, longitude), abs=most)


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
        own = replace(changed.ground, photo=photo, photo_extent=PHOTO if photo else ())
        shot = Shot(replace(changed, ground=own), run)
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
