"""Smoke in the scene: baked once, read by Blender, seen in the picture."""

import os
import shutil
import subprocess
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin import compat
from firetwin import project as projects
from firetwin.scene import bake, build, burning, clock, paths, smoke
from firetwin_core import InputError
from firetwin_core import run as runs


@pytest.fixture
def smoky(project):
    """The small project with smoke."""
    return replace(project, smoke=projects.Smoke(voxel_size=120.0, max_age=1800.0))


def grids(path):
    """Name -> values and lowest voxel of each grid of a file."""
    bpy.utils.expose_bundled_modules()
    import openvdb

    found = {}
    for header in openvdb.readAllGridMetadata(str(path)):
        grid = openvdb.read(str(path), header.name)
        low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
        values = np.zeros(np.maximum(high - low + 1, 0), np.float32)
        if values.size:
            grid.copyToArray(values, ijk=tuple(int(v) for v in low))
        found[header.name] = (values, low)
    return found


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


def test_the_key_is_what_is_in_the_run_not_when_it_was_written(smoky, run, run_folder, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(run_folder, copy)
    again = runs.open(copy)
    assert bake.folder(smoky, again) == bake.folder(smoky, run)
    fuel = np.load(copy / "surface_fuel.npy")
    fuel[60, 60] += 0.1
    np.save(copy / "surface_fuel.npy", fuel)
    assert bake.folder(smoky, again) != bake.folder(smoky, run)
    shutil.copy(run_folder / "surface_fuel.npy", copy)
    assert bake.folder(smoky, again) == bake.folder(smoky, run)
    np.save(copy / "temperature.npy", np.full((11, 24, 24), 300.0, np.float32))  # nobody asks it
    assert bake.folder(smoky, again) == bake.folder(smoky, run)
    np.save(copy / "heat_flux.npy", 2.0 * np.load(copy / "heat_flux.npy"))  # flames light the smoke
    assert bake.folder(smoky, again) != bake.folder(smoky, run)


def test_frames_in_parallel_are_the_frames_one_by_one(smoky, run, tmp_path, monkeypatch):
    def frames(cache, at_once):
        monkeypatch.setattr(bake, "_at_once", lambda frames: at_once)
        place = bake.bake(replace(smoky, cache=tmp_path / cache), run)
        return [grids(place / f"smoke_{n:06d}.vdb") for n in (1, 2, 3)]

    for one, other in zip(frames("one", 1), frames("many", 3), strict=True):
        assert one.keys() == other.keys() == {"density", "dilution", "shade", "size", "glow"}
        for name, (values, low) in one.items():
            assert np.array_equal(values, other[name][0])
            assert np.array_equal(low, other[name][1])


def test_what_a_killed_process_left_is_cleared(smoky, run):
    place = bake.folder(smoky, run)
    place.mkdir(parents=True)
    gone = subprocess.Popen(["true"])
    gone.wait()
    left, alive = place / f"smoke_000001.vdb.{gone.pid}.tmp", place / f"smoke_000009.vdb.{os.getpid()}.tmp"
    left.touch()
    alive.touch()
    bake.bake(smoky, run)
    assert not left.exists()
    assert alive.exists()


def test_frames_that_the_shot_does_not_have_are_no_error(smoky, run):
    place = bake.bake(smoky, run, frames=[-3, 0, 2, 4, 99])
    assert [file.name for file in place.iterdir()] == ["smoke_000002.vdb"]


def test_smoke_of_the_model_is_used_where_the_run_has_it(smoky, run, run_folder, tmp_path):
    folder = tmp_path / "levels"
    shutil.copytree(run_folder, folder)
    levels = run.elevation + np.linspace(10.0, 3000.0, 12, dtype=np.float32)[:, None, None]
    smoke = np.zeros((len(run.times), *levels.shape), np.float32)
    smoke[:, 4:8, 8:16, 8:16] = 1.0e-6 * (1.0 + np.arange(len(run.times)))[:, None, None, None]
    np.save(folder / "height_3d.npy", levels)
    np.save(folder / "smoke_3d.npy", smoke)
    model = runs.open(folder)
    whole = replace(smoky, smoke=replace(smoky.smoke, complete=True))
    assert bake.folder(whole, model) != bake.folder(whole, run)
    found = grids(bake.bake(whole, model, frames=[2]) / "smoke_000002.vdb")
    assert {"density", "dilution", "shade", "size", "temperature"} <= set(found)
    time = bake.Baker(whole, model).times[1]
    expected = 0.1 * (1.0 + np.interp(time, run.times, np.arange(len(run.times))))
    assert found["dilution"][0].max() == pytest.approx(expected, rel=1e-3)


def test_no_picture_changes_without_what_it_does_not_see(smoky, run, scene, shoot, tmp_path):
    """Left out smoke changes the picture by less than the grain of other seeds does."""
    far = replace(smoky.cameras[0], focal_length=200.0)
    close = replace(smoky, cameras=(far,), cache=tmp_path / "close")
    whole = replace(close, smoke=replace(close.smoke, complete=True), cache=tmp_path / "whole")
    pictures, sizes = [], []
    for project in (whole, close):
        place = bake.bake(project, run, frames=[3])
        sizes.append((place / "smoke_000003.vdb").stat().st_size)
        build.build(project, run, scene)
        scene.frame_set(3)
        pictures.append(shoot(scene, "rgb"))
    scene.cycles.seed += 1
    grain = np.abs(shoot(scene, "rgb") - pictures[1]).mean()
    change = np.abs(pictures[1] - pictures[0]).mean()
    print(f"bytes {sizes}, change {change:.2e}, grain {grain:.2e}")
    assert sizes[1] < 0.8 * sizes[0]
    assert change < 0.2 * grain


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


def test_eevee_slices_lie_where_the_smoke_is(smoky, run, scene):
    smoke.build(smoky, run)
    cells = burning.cells(run, *clock.window(smoky, run)).position
    nearest = min(view.distance(cells).min() for view in paths.paths(smoky, run) if view.perspective)
    eevee = scene.eevee
    assert eevee.use_volume_custom_range
    assert eevee.use_volumetric_shadows
    assert eevee.volumetric_start < nearest < nearest + 20_000.0 < eevee.volumetric_end
