import bpy
import numpy as np
import pytest
from firetwin.scene import build
from firetwin.scene.forest import visibility

pytestmark = pytest.mark.usefixtures("whole_forest")


def test_skipping_what_no_camera_sees_does_not_change_the_picture(shot, stage, scene, shoot, monkeypatch):
    build.build(shot, scene)
    skipped = shoot(scene, "rgb")
    count = len(bpy.data.objects["Firetwin Trees"].data.vertices)
    monkeypatch.setattr(visibility, "visible", lambda _shot, places, *_, **_more: np.ones(len(places), bool))
    build.build(shot, scene)
    full = shoot(scene, "rgb")
    assert len(bpy.data.objects["Firetwin Trees"].data.vertices) > 1.5 * count
    assert np.abs(full - skipped).mean() < 0.01 * full.mean()
    assert np.quantile(np.abs(full - skipped), 0.98) < 0.05 * full.mean()
