"""Labels face the camera, are as large in every picture, fade, and are in the visible picture alone."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.render import layers
from firetwin.scene import build
from firetwin.shot.sections import LabelSettings
from firetwin.shot.shot import Shot


@pytest.fixture
def labelled(settings, tmp_path):
    path = tmp_path / "places.csv"
    path.write_text(
        "name,latitude,longitude\nNear,38.840,-120.555\nFar,38.872,-120.545\nElsewhere,10.0,20.0\n"
    )
    return replace(settings, labels=LabelSettings(enabled=True, file=path, size=0.1))


def test_only_the_visible_picture_has_labels(labelled, run, stage, scene, shoot):
    pictures = []
    for enabled in (True, False):
        settings = replace(labelled, labels=replace(labelled.labels, enabled=enabled))
        build.build(Shot(settings, run), scene)
        layers.build(settings, stage)
        scene.frame_set(1)
        pictures.append((shoot(scene, "rgb"), shoot(scene, "thermal")))
    (shown, warm), (plain, cold) = pictures
    assert (np.abs(shown - plain).max(axis=-1) > 0.3).sum() > 5
    assert np.array_equal(warm, cold)
