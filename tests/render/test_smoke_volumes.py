"""Renders of a .blend file whose smoke volumes are missing: a notice, or smoke, but never clear air."""

import bpy
import firetwin
import numpy as np
import smoke_scene
from firetwin.blender import owned
from firetwin.jobs import worker
from firetwin.scene.smoke import volume_files
from firetwin.shot.source import ShotSource
from firetwin.smoke import bake


def test_a_frame_is_rendered_with_its_smoke_or_with_a_notice(run_folder, shoot, tmp_path, monkeypatch):
    """With the add-on the picture equals the one of volumes that were written before."""
    smoke_scene.write(tmp_path, run_folder)
    monkeypatch.setattr(worker, "run", smoke_scene.here)

    def picture():
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
        bpy.context.scene.frame_set(2)
        return shoot(bpy.context.scene, "rgb")

    noticed = picture()
    firetwin.register()
    on_demand = picture()
    firetwin.unregister()
    assert volume_files.missing(owned.stage(bpy.context.scene)) == [1, 3]
    (place,) = {path.parent for path in (tmp_path / "cache").rglob("*.vdb")}
    for path in place.iterdir():
        path.unlink()
    bake.bake(ShotSource(scene=str(tmp_path / "scene.toml")).shot())
    assert np.array_equal(picture(), on_demand)
    for obj in volume_files.volumes(owned.stage(bpy.context.scene)):
        obj.hide_render = True
    clear = shoot(bpy.context.scene, "rgb")
    assert np.mean(np.abs(clear - on_demand)) > 0.02
    red, _, blue = np.moveaxis(noticed, -1, 0)
    letters = np.abs(noticed - clear).max(axis=-1) > 0.05
    assert letters.mean() > 0.01
    assert (red > 1.5 * blue)[letters].mean() > 0.2, "the rest is their black outline"
    assert not letters[:6].any()
