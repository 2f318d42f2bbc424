"""Smoke in the scene: baked once, read by Blender, seen in the picture."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin import compat
from firetwin import project as projects
from firetwin.scene import bake, build, smoke
from firetwin_core import InputError
from firetwin_core import run as runs


@pytest.fixture
def smoky(project):
    """The small project with smoke."""
    return replace(project, smoke=projects.Smoke(voxel_size=120.0, max_age=1800.0))


def test_bake_writes_what_is_missing_and_nothing_else(smoky, run):
    told = []
    place = bake.bake(smoky, run, lambda *done: told.append(done[:2]))
    files = sorted(place.iterdir())
    assert [file.name for file in files] == [f"smoke_{n:06d}.vdb" for n in (1, 2, 3)]
    assert told[-1] == (3, 3)
    files[1].unlink()
    stamps = [files[i].stat().st_mtime_ns for i in (0, 2)]
    assert bake.bake(smoky, run) == place
    assert files[1].exists()
    assert [files[i].stat().st_mtime_ns for i in (0, 2)] == stamps


def test_other_settings_have_another_folder(smoky, run):
    before = bake.folder(smoky, run)
    assert bake.folder(smoky, run) == before
    assert bake.folder(replace(smoky, seed=smoky.seed + 1), run) != before
    assert bake.folder(replace(smoky, smoke=replace(smoky.smoke, voxel_size=90.0)), run) != before
    assert bake.folder(replace(smoky, light=projects.Light(haze=0.0)), run) == before


def test_only_frames_of_the_visible_pass_are_baked(smoky):
    thermal = replace(smoky.cameras[0], name="a", passes=("thermal",))
    still = replace(smoky.cameras[0], name="b", frames="2")
    assert bake.shot_frames(replace(smoky, cameras=(thermal, still))) == [2]


def test_a_cache_that_cannot_be_made_is_named(smoky, run, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="cache"):
        bake.bake(replace(smoky, cache=tmp_path / "file"), run)


def test_smoke_lies_beside_the_scene_file_wherever_that_is_called_from(run_folder, tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    text = f'run = "{run_folder}"\ncache = "kept"\n[[cameras]]\nname = "a"\nkind = "satellite"\n'
    (tmp_path / "sub" / "scene.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    loaded = projects.load("sub/scene.toml")
    assert bake.folder(loaded, runs.open(loaded.run)).parent == tmp_path / "sub" / "kept"


def test_steps_suit_the_extinction(smoky, run):
    drawn = bake.resolution(smoky, run)
    assert drawn.voxel == 120.0
    assert drawn.step * drawn.extinction <= 1.0
    given = replace(smoky, smoke=replace(smoky.smoke, extinction=0.03))
    assert bake.resolution(given, run).step == pytest.approx(drawn.step * drawn.extinction / 0.03)


def test_blender_reads_the_grids_of_every_frame(smoky, run, scene):
    bake.bake(smoky, run)
    thing = smoke.build(smoky, run)
    for frame in (1, 3):
        scene.frame_set(frame)
        grids = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.grids
        assert grids.load()
        assert {"density", "dilution", "shade", "size", "glow"} <= {grid.name for grid in grids}
        assert grids.frame_filepath.endswith(f"smoke_{frame:06d}.vdb")
    assert tuple(thing.location) == (compat.volume_shift(scene.cycles, 120.0),) * 3


def test_smoke_is_off_when_it_is_off(project, run, scene):
    assert smoke.build(project, run) is None


def test_smoke_changes_the_picture(smoky, run, scene, shoot):
    bake.bake(smoky, run, frames=[3])
    build.build(smoky, run, scene)
    scene.frame_set(3)
    shown = shoot(scene, "rgb")
    bpy.data.objects["Firetwin Smoke"].hide_render = True
    assert np.mean(np.abs(shown - shoot(scene, "rgb"))) > 0.02
