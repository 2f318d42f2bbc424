"""Smoke in the scene: baked once, read by Blender, seen in the picture."""

import locale
import os
import shutil
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import bpy
import levels_run
import numpy as np
import plumes
import pytest
from firetwin.blender import compat, owned
from firetwin.run import opening as runs
from firetwin.scene.smoke import build as smoke
from firetwin.scene.smoke import volume_files
from firetwin.shot.cameras import visibility
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.sections import Light, SmokeSettings
from firetwin.shot.settings import Camera
from firetwin.shot.settings import scene_file as file
from firetwin.shot.shot import Shot
from firetwin.smoke import bake, cache, sources
from firetwin.smoke.sources.model import ModelSource
from firetwin_core import InputError, lod


@pytest.fixture(scope="module")
def levels_folder(run_folder, tmp_path_factory):
    """The small run, with smoke on levels."""
    return levels_run.write(run_folder, tmp_path_factory.mktemp("levels") / "run")


@pytest.fixture
def run(levels_folder):
    return runs.open(levels_folder)


@pytest.fixture
def smoky(settings):
    return replace(settings, smoke=SmokeSettings(voxel_size=120.0))


@pytest.fixture
def shot(smoky, run):
    return Shot(smoky, run)


def test_bake_writes_what_is_missing_and_nothing_else(shot):
    told = []
    place = bake.bake(shot, lambda *done: told.append(done[:2]))
    files = sorted(place.glob("*.vdb"))
    assert [file.name for file in files] == [f"smoke_{n:06d}.vdb" for n in (1, 2, 3)]
    assert {*place.iterdir()} - {*files} == {bake.marker(file) for file in files}
    assert told[-1] == (3, 3)
    files[1].unlink()
    stamps = [files[i].stat().st_mtime_ns for i in (0, 2)]
    assert bake.bake(shot) == place
    assert files[1].exists()
    assert [files[i].stat().st_mtime_ns for i in (0, 2)] == stamps


def test_other_settings_have_another_folder(smoky, run):
    before = bake.folder(Shot(smoky, run))
    assert bake.folder(Shot(smoky, run)) == before
    assert bake.folder(Shot(replace(smoky, seed=smoky.seed + 1), run)) != before
    assert bake.folder(Shot(replace(smoky, smoke=replace(smoky.smoke, voxel_size=90.0)), run)) != before
    assert bake.folder(Shot(replace(smoky, light=Light(haze=0.0)), run)) == before


def test_how_smoke_is_shown_and_recorded_needs_no_other_volumes(smoky, run):
    before = bake.folder(Shot(smoky, run))
    camera, render = smoky.cameras[0], smoky.render
    for same in (
        replace(smoky, render=replace(render, passes=("rgb",))),
        replace(smoky, cameras=(replace(camera, passes=("depth", "rgb")),)),
        replace(smoky, cameras=(replace(camera, name="b", frames="1-3"),)),
        replace(smoky, render=replace(render, engine="eevee", samples=99)),
        replace(smoky, render=replace(render, resolution=(128, 72))),
        replace(smoky, time=replace(smoky.time, fps=30)),
    ):
        assert bake.folder(Shot(same, run)) == before
    for other in (
        replace(smoky, render=replace(render, resolution=(64, 64))),
        replace(smoky, cameras=(replace(camera, frames="2"),)),
        replace(smoky, cameras=(replace(camera, rig=replace(camera.rig, focal_length=50.0)),)),
        replace(smoky, time=replace(smoky.time, frames=4)),
        replace(smoky, smoke=replace(smoky.smoke, complete=True)),
    ):
        assert bake.folder(Shot(other, run)) != before


def test_the_key_is_what_is_in_the_run_not_when_it_was_written(smoky, run, levels_folder, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(levels_folder, copy)
    again = runs.open(copy)

    def folder(run):
        return bake.folder(Shot(smoky, run))

    assert folder(again) == folder(run)
    fuel = np.load(copy / "surface_fuel.npy")
    fuel[60, 60] += 0.1
    np.save(copy / "surface_fuel.npy", fuel)
    assert folder(again) != folder(run)
    shutil.copy(levels_folder / "surface_fuel.npy", copy)
    assert folder(again) == folder(run)
    np.save(copy / "temperature.npy", np.full((11, 24, 24), 300.0, np.float32))  # nobody asks it
    assert folder(again) == folder(run)
    np.save(copy / "heat_flux.npy", 2.0 * np.load(copy / "heat_flux.npy"))  # flames light the smoke
    assert folder(again) != folder(run)


def test_frames_in_parallel_are_the_frames_one_by_one(smoky, run, tmp_path, monkeypatch):
    def frames(cache, at_once):
        monkeypatch.setattr(bake, "_parallel_frames", lambda frames: at_once)
        place = bake.bake(Shot(replace(smoky, cache=tmp_path / cache), run))
        return [plumes.read(place / f"smoke_{n:06d}.vdb") for n in (1, 2, 3)]

    for one, other in zip(frames("one", 1), frames("many", 3), strict=True):
        assert one.keys() == other.keys() == {"density", "dilution", "shade", "size", "glow"}
        for name, (values, low) in one.items():
            assert np.array_equal(values, other[name][0])
            assert np.array_equal(low, other[name][1])


def test_what_a_killed_process_left_is_cleared(shot):
    place = bake.folder(shot)
    place.mkdir(parents=True)
    left, alive = place / ".smoke_000001.0123456789ab.part.vdb", place / ".smoke_000009.ba9876543210.part.vdb"
    left.touch()
    alive.touch()
    os.utime(left, (0, time.time() - 2 * cache.IN_USE))
    bake.bake(shot)
    assert not left.exists()
    assert alive.exists()


def test_frames_that_the_shot_does_not_have_are_no_error(shot):
    place = bake.bake(shot, frames=[-3, 0, 2, 4, 99])
    assert sorted(file.name for file in place.iterdir()) == ["smoke_000002.txt", "smoke_000002.vdb"]


def test_smoke_of_the_model_is_used_where_the_run_has_it(smoky, run, run_folder, levels_folder, tmp_path):
    folder = tmp_path / "levels"
    shutil.copytree(levels_folder, folder)
    whole = replace(smoky, smoke=replace(smoky.smoke, complete=True))
    shot = Shot(whole, run)
    assert bake.folder(shot) != bake.folder(Shot(whole, runs.open(run_folder)))
    grids = plumes.read(bake.bake(shot, frames=[2]) / "smoke_000002.vdb")
    assert {"density", "dilution", "shade", "size", "temperature"} <= set(grids)
    time = shot.frames.times[1]
    expected = 0.1 * (1.0 + np.interp(time, run.times, np.arange(len(run.times))))
    assert grids["dilution"][0].max() == pytest.approx(expected, rel=1e-3)
    np.save(folder / "air_latitude.npy", run.latitude)  # the same, at separate points
    np.save(folder / "air_longitude.npy", run.longitude[::-1])
    for name in ("height_3d", "smoke_3d"):
        np.save(folder / f"{name}.npy", np.load(folder / f"{name}.npy")[..., ::-1])
    for name in {"temperature", "wind_east", "wind_north"} & set(run.fields):
        (folder / f"{name}.npy").unlink()
    again = plumes.read(bake.bake(Shot(whole, runs.open(folder)), frames=[2]) / "smoke_000002.vdb")
    np.testing.assert_allclose(again["dilution"][0], grids["dilution"][0], atol=1e-6)


def test_only_frames_whose_smoke_is_shown_are_baked(smoky, run):
    blind = replace(smoky.cameras[0], name="a", passes=("depth",))
    still = replace(smoky.cameras[0], name="b", frames="2")
    assert bake.shot_frames(Shot(replace(smoky, cameras=(blind, still)), run)) == [2]


def test_a_thermal_picture_shows_all_smoke(smoky, run, monkeypatch):
    thermal = replace(smoky.cameras[0], name="a", passes=("thermal",))
    still = replace(smoky.cameras[0], name="b", frames="2")
    shot = Shot(replace(smoky, cameras=(thermal, still)), run)
    assert bake.shot_frames(shot) == [1, 2, 3]
    shot.visibility.distance(np.zeros((1, 3)))  # the ground that hides is made with true sights
    monkeypatch.setattr(visibility.lod, "ViewSet", lambda cameras, *_, **_more: len(cameras))
    assert [shot.visibility.view_set(frame) for frame in (1, 2, 3)] == [1, 2, 1]


def test_a_camera_that_records_no_smoke_culls_none_of_anothers(smoky, run):
    above = Camera("above", Satellite(), passes=("depth",), frames="2")
    shot = Shot(replace(smoky, cameras=(*smoky.cameras, above)), run)
    eye, aim = shot.paths[0].position[1], shot.paths[0].target[1]
    seen = [
        lod.visible_mask([eye - (aim - eye)], 0.0, shot.visibility.view_set(frame))[0] for frame in (1, 2, 3)
    ]
    assert seen == [False, True, False]


@pytest.mark.parametrize("linked", [True, False])
def test_a_frame_that_one_camera_films_alone_is_that_cameras(smoky, run, tmp_path, monkeypatch, linked):
    if not linked:
        monkeypatch.setattr(os, "link", lambda *paths: os.stat(tmp_path / "no such file"))
    first = replace(smoky.cameras[0], frames="1-3")
    second = replace(first, name="second", frames="3")
    both = Shot(replace(smoky, cameras=(first, second), cache=tmp_path), run)
    told = []
    place = bake.bake(both, lambda *done: told.append(done))
    own = bake.folder(both.for_camera(first.name))
    assert {total for _, total, *_ in told} == {3}
    assert [done for done, *_ in told] == sorted(done for done, *_ in told)
    assert sorted(path.name for path in own.glob("*.vdb")) == ["smoke_000001.vdb", "smoke_000002.vdb"]
    for path in own.glob("*.vdb"):
        assert (place / path.name).samefile(path) == linked
        assert (place / path.name).read_bytes() == path.read_bytes()
    files = {path.stat().st_ino: path.stat().st_size for path in tmp_path.glob("*/*.vdb")}
    assert len(files) == (3 if linked else 5)
    kept = sum(each.bytes for each in cache.list_volumes(tmp_path))
    marks = sum(path.stat().st_size for path in tmp_path.glob("*/*.txt"))
    assert kept == pytest.approx(sum(files.values()) + marks, abs=len(files))


def test_a_cache_that_cannot_be_made_is_named(smoky, run, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="cache"):
        bake.bake(Shot(replace(smoky, cache=tmp_path / "file"), run))


def test_smoke_lies_beside_the_scene_file_wherever_that_is_called_from(run_folder, tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    text = f'run = "{run_folder.as_posix()}"\ncache = "kept"\n[[cameras]]\nname = "a"\nkind = "satellite"\n'
    (tmp_path / "sub" / "scene.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    loaded = file.read("sub/scene.toml")
    assert bake.folder(Shot(loaded, runs.open(loaded.run))).parent == tmp_path / "sub" / "kept"


def test_blender_reads_the_grids_of_every_frame(shot, stage, scene):
    bake.bake(shot)
    thing = smoke.build(shot, stage)
    for frame in (1, 3):
        scene.frame_set(frame)
        grids = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.grids
        assert grids.load()
        assert {"density", "dilution", "shade", "size", "glow"} <= {grid.name for grid in grids}
        assert grids.frame_filepath.endswith(f"smoke_{frame:06d}.vdb")
    assert tuple(thing.location) == (compat.volume_shift(scene.cycles, 120.0),) * 3


def test_a_folder_whose_volumes_blender_cannot_read_is_refused(monkeypatch):
    path = Path("cache") / "Straße" / "smoke_000001.vdb"
    assert sys.platform == "win32" or compat.volume_path(path) == str(path)
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(locale, "getencoding", lambda: "cp1252")
    with pytest.raises(InputError, match="Straße: is a folder that Blender reads no volumes from; set cache"):
        compat.volume_path(path)
    assert compat.volume_path(Path("smoke_000001.vdb")) == "smoke_000001.vdb"
    monkeypatch.setattr(locale, "getencoding", lambda: "cp65001")
    assert compat.volume_path(path) == str(path)


def test_smoke_is_off_when_it_is_off(settings, run, stage):
    assert smoke.build(Shot(settings, run), stage) is None


def test_eevee_slices_lie_where_the_smoke_is(shot, stage, scene):
    smoke.build(shot, stage)
    cells = shot.fire.cells(shot.frames.first, shot.frames.last).position
    nearest = shot.visibility.distance(cells).min()
    eevee = scene.eevee
    assert eevee.use_volume_custom_range
    assert eevee.use_volumetric_shadows
    assert eevee.volumetric_start < nearest < nearest + 20_000.0 < eevee.volumetric_end


@pytest.mark.parametrize("ours", [True, False])
def test_only_our_own_scene_gets_settings_of_smoke(shot, scene, ours):
    before = scene.cycles.volume_max_steps, scene.eevee.volumetric_end
    other = bpy.data.scenes.new("other")
    assert smoke.build(shot, owned.adopt(scene) if ours else owned.stage(scene)) is not None
    assert (other.cycles.volume_max_steps, other.eevee.volumetric_end) == before
    assert ((scene.cycles.volume_max_steps, scene.eevee.volumetric_end) != before) is ours


def test_a_file_moved_together_with_its_smoke_keeps_it(smoky, run, stage, tmp_path):
    here, there = tmp_path / "here", tmp_path / "there" / "deeper"
    blend = here / "films" / "scene.blend"
    blend.parent.mkdir(parents=True)
    shot = Shot(replace(smoky, cache=here / "cache"), run)
    bake.bake(shot)
    smoke.build(shot, stage)
    volume_files.make_paths_relative(blend)
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), relative_remap=False)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    there.parent.mkdir()
    here.rename(there)
    bpy.ops.wm.open_mainfile(filepath=str(there / "films" / "scene.blend"))
    volume = bpy.data.objects["Firetwin Smoke"].data
    assert volume.filepath.startswith("//")
    bpy.context.scene.frame_set(2)
    grids = bpy.data.objects["Firetwin Smoke"].evaluated_get(bpy.context.evaluated_depsgraph_get()).data.grids
    assert grids.load()
    assert {"density", "dilution", "shade", "size", "glow"} <= {grid.name for grid in grids}


def test_paths_that_are_not_ours_or_on_another_drive_stay(shot, stage, tmp_path, monkeypatch):
    volume = smoke.build(shot, stage).data
    theirs = bpy.data.volumes.new("theirs")
    theirs.filepath = absolute = volume.filepath

    def no_way(*_):
        raise ValueError

    with monkeypatch.context() as patched:
        patched.setattr(volume_files.os.path, "relpath", no_way)
        volume_files.make_paths_relative(tmp_path / "scene.blend")
    assert volume.filepath == absolute
    volume_files.make_paths_relative(tmp_path / "scene.blend")
    assert volume.filepath == f"//cache/{bake.folder(shot).name}/smoke_000001.vdb"
    assert theirs.filepath == absolute


def test_several_may_write_one_volume_at_once(smoky, run, tmp_path):
    """All of them finish, and nothing but the complete file is left."""
    shot = Shot(replace(smoky, smoke=replace(smoky.smoke, voxel_size=400.0)), run)
    path = tmp_path / "smoke_000003.vdb"
    maker = sources.select(shot)
    maker.write(path, 3)
    alone = plumes.read(path)
    path.unlink()
    for _ in range(5):
        with ThreadPoolExecutor(4) as pool:
            tasks = [pool.submit(maker.write, path, 3) for _ in range(4)]
        assert all(task.result().active_voxels for task in tasks)
    for name, (values, low) in plumes.read(path).items():
        assert np.array_equal(values, alone[name][0])
        assert np.array_equal(low, alone[name][1])
    assert [each.name for each in tmp_path.iterdir() if each.is_file()] == [path.name]


def test_the_first_picture_waits_for_its_own_volume_alone(shot, monkeypatch):
    written, go_on, told, said = [], threading.Semaphore(1), [], []
    write = ModelSource.write

    def slow(self, path, frame):
        go_on.acquire()
        written.append(frame)
        return write(self, path, frame)

    monkeypatch.setattr(ModelSource, "write", slow)
    with bake.ahead(shot, [1, 3, 2], lambda *done: told.append(done[:2]), said.append) as ready:
        ready(1)
        assert written == [1]
        assert bake.file(shot, 1).exists()
        assert told == [(0, 1), (1, 1)]
        go_on.release()
        ready(3)
        assert written == [1, 3]
        go_on.release()
        ready(2)
    assert written == [1, 3, 2]
    assert len(told) == 2
    assert len(said) == 1
    assert "3 frames" in said[0]


def test_leaving_cancels_what_has_not_begun(shot, monkeypatch):
    begun, go_on = threading.Event(), threading.Event()
    written = []

    def write(self, path, frame):
        written.append(frame)
        begun.set()
        go_on.wait(10.0)

    monkeypatch.setattr(ModelSource, "write", write)
    with bake.ahead(shot, [1, 2, 3]) as ready:
        waiting = threading.Thread(target=ready, args=(1,))
        waiting.start()
        begun.wait(10.0)
        threading.Timer(0.5, go_on.set).start()
        time.sleep(0.2)  # the second frame is in line now
    waiting.join(10.0)
    assert written == [1]


def test_what_goes_wrong_meanwhile_is_raised_when_it_is_wanted(shot, monkeypatch):
    write = ModelSource.write

    def wrong(self, path, frame):
        if frame == 2:
            raise OSError("the disk is full")
        return write(self, path, frame)

    monkeypatch.setattr(ModelSource, "write", wrong)
    with bake.ahead(shot, [1, 2]) as ready:
        ready(1)
        with pytest.raises(OSError, match="full"):
            ready(2)


def test_nothing_is_made_ahead_without_smoke(settings, run):
    shot = Shot(settings, run)
    with bake.ahead(shot, [1, 2]) as ready:
        ready(1)
    assert not bake.folder(shot).exists()


def test_room_is_estimated_from_what_is_there(shot):
    assert bake.estimate(shot, [1, 2, 3]) is None
    place = bake.bake(shot, frames=[2, 3])
    sizes = [path.stat().st_size for path in place.glob("*.vdb")]
    assert bake.estimate(shot, [1, 2, 3]) == round(3 * sum(sizes) / 2)
    assert bake.estimate(shot, range(-5, 100)) == bake.estimate(shot, [1, 2, 3])
