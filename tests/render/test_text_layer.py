"""Labels in pictures of few samples and a denoiser."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.render import engine, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.scene import build
from firetwin.scene.labels import material
from firetwin.shot import passes
from firetwin.shot.sections import LabelSettings
from firetwin.shot.shot import Shot
from firetwin_core import sensor

LETTERS = 0.1  # picture heights


def rgb(channels, layer=""):
    return np.stack([channels[layer + letter] for letter in "RGB"], axis=-1)


@pytest.fixture
def film(settings, run, tmp_path):
    """Render the visible picture of two samples, denoised, with or without labels."""
    path = tmp_path / "places.csv"
    path.write_text("name,latitude,longitude\nNear,38.840,-120.555\n")

    def make(seed=0, enabled=True, names=("rgb",)):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        stage = owned.adopt(bpy.context.scene)
        picture = replace(settings.render, resolution=(192, 108), samples=2, seed=seed, denoise=True)
        words = LabelSettings(enabled=enabled, file=path, size=LETTERS)
        shot = Shot(replace(settings, render=picture, labels=words), run)
        build.build(shot, stage.scene)
        layers.build(shot.settings, stage)
        engine.apply(shot.settings, stage.scene)
        out = tmp_path / f"{seed}_{enabled}"
        out.mkdir()
        camera = shot.settings.cameras[0].name
        with open_session(out, {(camera, name): {"pass": name} for name in passes.known()}) as here:
            wanted = [Picture(camera, 1, name) for name in names]
            pictures.render(shot, stage, here, wanted, ready=lambda frame, ahead: None)
        return {each.name: sensor.read_channels(out / each.file("exr")) for each in wanted}

    return make


def test_letters_are_sharp_in_few_samples_and_a_layer_over_the_picture_for_compositors(film):
    layered = film(names=("rgb", "comp"))
    first, second, none = (rgb(each["rgb"]) for each in (layered, film(seed=1), film(enabled=False)))
    written = np.abs(first - none).max(axis=-1) > 0.2
    assert 50 < written.sum() < 400
    assert np.abs(first - second)[written].mean() < 0.06, "no grain, which a denoiser would smear"
    assert first[written].max() > 0.6 * material._LIGHT, "of the stem, which is one pixel wide"
    parts = layered["comp"]
    assert rgb(parts) == pytest.approx(none, rel=2e-3, abs=1e-4), "R, G, B have no labels"
    over = rgb(parts) * (1.0 - parts["labels.A"])[..., None] + rgb(parts, "labels.")
    assert over == pytest.approx(first, rel=4e-3, abs=1e-3)
    assert 50 < (parts["labels.A"] > 0.5).sum() < 400
