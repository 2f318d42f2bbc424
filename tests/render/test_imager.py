"""Pixels of a geostationary imager in a rendered picture: their position on Earth, by depth."""

from dataclasses import replace

import numpy as np
from firetwin.render import engine, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.scene.camera import build as cameras
from firetwin.scene.terrain import build as ground
from firetwin.shot import passes
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.satellites import imager
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor


def test_a_rendered_picture_from_over_the_equator_shows_the_imagers_pixels(
    settings, run, stage, scene, tmp_path
):
    camera = Camera("goes", Satellite(swath=14_000.0, geostationary=-137.0))
    size = replace(settings.render, resolution=(80, 80), samples=1)  # too small for a bar and labels
    shot = Shot(replace(settings, cameras=(camera,), render=size), run)
    ground.build(shot, stage, None)
    cameras.build(shot, stage)
    layers.build(shot.settings, stage)
    engine.apply(shot.settings, scene)
    wanted = [Picture("goes", 2, name) for name in ("depth", "imager_short")]
    made_with = {("goes", name): {"pass": name} for name in passes.known()}
    with open_session(tmp_path / "out", made_with) as here:
        pictures.render(shot, stage, here, wanted)
    shown = sensor.read_image(tmp_path / "out" / wanted[1].file("png"))[..., :3]
    seen = imager.picture(imager.ABI, imager.grid_of(imager.ABI, run, -137.0), shot.fire, 1800.0)
    imaged = np.abs(shown - 0.12).max(axis=-1) > 0.02
    view = shot.paths[0]
    for row, column in np.ndindex(seen.short.shape):
        place = seen.grid.reverse(*(np.array([n + 0.5]) for n in (seen.row + row, seen.column + column)))
        there = shot.local_frame.forward(*place, np.zeros(1))[0]
        there[2] = shot.bare_ground.up(*there[:2])[0]
        local = view.rotation[1].T @ (there - view.position[1])
        x, y = (80 * (0.5 + 0.5 * np.array([1, -1]) * local[:2] / view.half)).astype(int)
        expected = sensor.colour([[seen.short[row, column]]], shot.air.coldest, 400.0, "inferno", 20.0)
        assert imaged[y, x]
        assert np.abs(shown[y, x] - expected[0, 0]).max() < 0.51 / 255
    assert 0.05 < imaged.mean() < 0.6
