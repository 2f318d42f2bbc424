"""Smoke solved as a flow: frames show the solution, which is computed once despite interruptions."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from firetwin.run import opening as runs  # noqa: E402
from firetwin.shot.cameras import rigs  # noqa: E402
from firetwin.shot.shot import Shot  # noqa: E402
from firetwin.smoke import bake, domains, flow, flow_frames, integrator, plume_mass, snapshots  # noqa: E402


@pytest.fixture
def flowing(settings, few_cells, monkeypatch):
    """Settings of two frames whose smoke is a flow on few, large cells."""
    monkeypatch.setattr(domains, "_DOWNWIND", (0.0, 0.0))
    camera = replace(settings.cameras[0], frames="1-2")
    time = replace(settings.time, start=datetime(2014, 9, 17, 21, 30, tzinfo=UTC), end=None, frames=40)
    smoke = replace(settings.smoke, enabled=True, method="flow", spin_up=120.0, voxel_size=200.0)
    return replace(settings, smoke=smoke, time=time, cameras=(camera,))


@pytest.fixture
def shot(flowing, run):
    return Shot(flowing, run)


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix == ".npz"}


def grids(path):
    bpy.utils.expose_bundled_modules()
    import openvdb

    found, metadata = openvdb.readAll(str(path))
    return {grid.name: grid for grid in found}, metadata


def test_what_frames_say_is_what_was_solved(shot):
    solved = flow.Flow(shot)
    assert len(solved.domains) == 2
    solved.ready(2)
    assert solved._integrator is not None
    for domain, solver in zip(solved.domains, solved._integrator.solvers, strict=True):
        moment = snapshots.load(domain.snapshot_path(2))
        high, rows, columns = moment.fields["smoke"].shape
        west, south = moment.low
        volume = domain.volumes()[:high, south : south + rows, west : west + columns]
        held = float((moment.fields["smoke"].astype(float) * volume).sum())
        mass = moment.mass
        assert mass["airborne"] > 0.0
        assert held == pytest.approx(mass["airborne"], rel=1e-6)
        balance = mass["initial"] + mass["emitted"] + mass["entered"] + mass["rounding"]
        assert mass["airborne"] + mass["left"] == pytest.approx(balance, rel=1e-6)
        assert np.allclose(domain.heights(), solver.heights(), atol=0.01)


def test_the_smoke_is_that_of_the_fire(shot):
    solved = flow.Flow(shot)
    solved.ready(1)
    emitted = snapshots.load(solved.domains[0].snapshot_path(1)).mass["emitted"]
    assert emitted == pytest.approx(shot.fire.smoke_made(solved.begin, shot.frames.first), rel=1e-3)


def test_how_deep_smoke_is_comes_from_its_mass(shot):
    solved = flow.Flow(shot)
    solved.ready(1)
    (domain, *_) = solved.domains
    moment = snapshots.load(domain.snapshot_path(1))
    depth = plume_mass.columns(domain, *snapshots.load_smoke(domain.snapshot_path(1)))
    mass = depth.sum() * domain.box.spacing**2 / 4000.0  # at 4 m2/g
    assert mass == pytest.approx(moment.mass["airborne"], rel=1e-3)
    found = plume_mass.measure(shot)
    assert found.deepest >= depth.max() >= found.mean > 0.0
    assert found.deepest >= found.wide
    first, last = shot.frames.first, shot.frames.last
    power = [shot.fire.sources(time).smoke.sum() for time in np.arange(first + 0.5, last)]
    assert found.made == pytest.approx(np.sum(power), rel=0.02)
    assert "of smoke in" in plume_mass.describe(shot)
    assert "optical depth" in plume_mass.describe(shot)


def test_going_on_after_an_interruption_gives_the_same_bytes(flowing, run, tmp_path, monkeypatch):
    whole = flow.Flow(Shot(replace(flowing, cache=tmp_path / "whole"), run))
    whole.ready(2)
    monkeypatch.setattr(integrator, "_SAVE", 0.0)
    broken = replace(flowing, cache=tmp_path / "broken")

    before = []

    def stop(done, total, what):
        before.append(done)
        if len(before) == 12:  # after the nest has begun
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        flow.Flow(Shot(broken, run)).ready(2, stop)
    last = flow.Flow(Shot(broken, run))
    seen = []
    last.ready(2, lambda done, total, what: seen.append(done))
    assert seen[0] == before[-1]
    for one, other in zip(whole.domains, last.domains, strict=True):
        assert one.folder.name == other.folder.name
        assert one.snapshot_path(2).read_bytes() == other.snapshot_path(2).read_bytes()


def test_a_broken_checkpoint_is_left_and_made_anew(flowing, run, tmp_path, monkeypatch):
    """Cut off, of other shapes, or no such file at all: solved from the beginning, to the same bytes."""
    whole = flow.Flow(Shot(replace(flowing, cache=tmp_path / "whole"), run))
    whole.ready(2)
    monkeypatch.setattr(integrator, "_SAVE", 0.0)
    other = flow.Flow(Shot(replace(flowing, cache=tmp_path / "other"), run))
    other.ready(1)
    state = other.domains[-1].folder / integrator.STATE
    kept = snapshots.read(state)
    breaks = [
        lambda: state.write_bytes(state.read_bytes()[:50_000]),
        lambda: state.write_bytes(b""),
        lambda: snapshots.write(state, kept | {"0_u": kept["0_u"][:, 1:]}),
        lambda: snapshots.write(state, kept | {"1_smoke": kept["1_smoke"][:3]}),
        lambda: snapshots.write(state, {name: kept[name] for name in kept if name != "1_account"}),
        lambda: snapshots.write(state, kept | {"step": np.array([10**6])}),
        lambda: snapshots.write(state, kept | {"step": np.array(["x"])}),
    ]
    for spoil in breaks:
        spoil()
        for domain in other.domains:
            domain.snapshot_path(2).unlink(missing_ok=True)
        again = flow.Flow(other.shot)
        seen = []
        again.ready(2, lambda done, total, what, seen=seen: seen.append(done))
        assert seen[0] == 0
        for one, two in zip(whole.domains, again.domains, strict=True):
            assert one.snapshot_path(2).read_bytes() == two.snapshot_path(2).read_bytes()


def test_a_broken_moment_is_solved_again(flowing, run, tmp_path):
    """Cut off, empty, of other shapes, of another box, damaged in the middle, or without a field."""
    shot = Shot(replace(flowing, cache=tmp_path / "broken"), run)
    place = bake.bake(shot, frames=[1])
    path = flow.Flow(shot).domains[0].snapshot_path(1)
    whole, kept = path.read_bytes(), snapshots.read(path)
    middle = len(whole) // 3
    breaks = {
        "cut": lambda: path.write_bytes(whole[: len(whole) // 2]),
        "nothing": lambda: path.write_bytes(b""),
        "shapes": lambda: snapshots.write(path, kept | {"smoke": kept["smoke"][1:]}),
        "place": lambda: snapshots.write(path, kept | {"low": np.array([9999, 0])}),
        "middle": lambda: path.write_bytes(whole[:middle] + bytes(2000) + whole[middle + 2000 :]),
        "missing": lambda: snapshots.write(path, {name: kept[name] for name in kept if name != "drift"}),
    }
    for name, spoil in breaks.items():
        for volume in place.iterdir():
            volume.unlink()
        spoil()
        assert path.read_bytes() != whole, name
        assert bake.bake(shot, frames=[1]) == place
        assert path.read_bytes() == whole, name
        assert (place / "far_000001.vdb").exists(), name


def test_an_earlier_frame_than_the_checkpoint_is_solved(flowing, run, tmp_path, monkeypatch):
    monkeypatch.setattr(integrator, "_SAVE", 0.0)
    first = flow.Flow(Shot(replace(flowing, cache=tmp_path / "a"), run))
    first.ready(3)
    path = first.domains[0].snapshot_path(1)
    whole, state = path.read_bytes(), (first.domains[-1].folder / integrator.STATE).read_bytes()
    path.unlink()
    flow.Flow(first.shot).ready(1)
    assert path.read_bytes() == whole
    assert (first.domains[-1].folder / integrator.STATE).read_bytes() == state


def test_only_what_is_asked_for_is_solved(shot):
    solved = flow.Flow(shot)
    seen = []
    solved.solve([1, 2], lambda done, total, what: seen.append((done, total)))
    assert {path.name for path in solved.domains[0].folder.glob("moment*")} == {
        "moment_000001.npz",
        "moment_000002.npz",
    }
    assert len({total for _, total in seen}) == 1
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)
    assert seen[-1][0] == seen[-1][1]


def test_who_comes_second_waits_for_the_first(shot):
    """One solves; the other finds the moments there."""
    first, second = flow.Flow(shot), flow.Flow(shot)
    begun = threading.Event()
    waited = []

    def slowly(done, total, what):
        begun.set()
        time.sleep(0.05)

    thread = threading.Thread(target=first.ready, args=(1, slowly))
    thread.start()
    assert begun.wait(20)
    second.ready(1, lambda done, total, what: waited.append(what))
    thread.join()
    assert second._integrator is None
    assert waited == ["waiting for another process to solve the smoke's flow"]


def test_frames_in_any_order_are_the_same(flowing, run, tmp_path):
    forwards = flow.Flow(Shot(replace(flowing, cache=tmp_path / "a"), run))
    forwards.solve([1, 2])
    backwards = flow.Flow(Shot(replace(flowing, cache=tmp_path / "b"), run))
    backwards.ready(2)
    backwards.ready(1)
    for one, other in zip(forwards.domains, backwards.domains, strict=True):
        for frame in (1, 2):
            assert one.snapshot_path(frame).read_bytes() == other.snapshot_path(frame).read_bytes()


def test_baked_once_nothing_is_solved_again(shot, monkeypatch):
    place = bake.bake(shot)
    assert {path.name for path in place.glob("*.vdb")} == {
        f"{name}_{frame:06d}.vdb" for name in ("smoke", "far") for frame in (1, 2)
    }
    written = {path: path.stat().st_mtime_ns for path in place.iterdir()}
    monkeypatch.setattr(flow, "Integrator", lambda *_: pytest.fail("solved again"))
    assert bake.bake(Shot(shot.settings, shot.run)) == place
    assert {path: path.stat().st_mtime_ns for path in place.iterdir()} == written


def test_a_moved_camera_keeps_the_flow(flowing, run, monkeypatch):
    """A little: both boxes. To where no nest helps: the box, whose moments are there already."""
    first = flow.Flow(Shot(flowing, run))
    first.ready(1)
    monkeypatch.setattr(flow, "Integrator", lambda *_: pytest.fail("solved again"))

    def seen_from(latitude):
        camera = flowing.cameras[0]
        keys = tuple(replace(key, latitude=key.latitude + latitude) for key in camera.rig.keys)
        moved = replace(camera, rig=replace(camera.rig, keys=keys))
        return flow.Flow(Shot(replace(flowing, cameras=(moved,)), run))

    near, far = seen_from(0.001), seen_from(1.0)
    assert near.key() == first.key()
    assert far.key() == first.key()[:1]
    near.ready(1)
    far.ready(1)


def test_what_nobody_sees_is_not_painted_and_nothing_else_changes(shot, flowing, run, tmp_path, monkeypatch):
    solved = flow.Flow(shot)
    solved.ready(1)
    painter = flow_frames.Painter(shot, flow_frames.layers(shot, solved)[-1], None)
    views = shot.visibility.view_set(1)
    asked = []
    real = flow_frames._visible_blocks

    def wanted(*given):
        asked.append(real(*given))
        return asked[-1]

    monkeypatch.setattr(flow_frames, "_visible_blocks", wanted)
    painter.write(tmp_path / "some.vdb", 1, None, views, {})
    monkeypatch.setattr(flow_frames, "_visible_blocks", lambda *given: None)
    painter.write(tmp_path / "all.vdb", 1, None, views, {})
    assert asked[0].any()
    some, whole = grids(tmp_path / "some.vdb")[0], grids(tmp_path / "all.vdb")[0]
    for name in ("density", "fresh", "sun", "sky"):
        assert some[name].activeVoxelCount() == whole[name].activeVoxelCount() > 0
        assert some[name].evalActiveVoxelBoundingBox() == whole[name].evalActiveVoxelBoundingBox()


def test_smoke_hides_smoke_from_those_cameras_that_film_the_frame(flowing, run, monkeypatch):
    drone = flowing.cameras[0]
    above = replace(drone, name="above", rig=rigs.kinds()["satellite"](), frames="2")
    shot = Shot(replace(flowing, cameras=(replace(drone, frames="1"), above)), run)
    asked, real = [], flow_frames.volume.occluded_smoke

    def hidden(*given):
        asked.append(given[2:4])
        return real(*given)

    monkeypatch.setattr(flow_frames.volume, "occluded_smoke", hidden)
    bake.bake(shot, frames=[1])
    near = asked.copy()
    bake.bake(shot, frames=[2])
    far = asked[len(near) :]
    assert len(near) == len(far) == 2  # layers
    for places, directions in near:
        assert places == pytest.approx(shot.paths[0].position[:1])
        assert directions.shape == (0, 3)
    for places, directions in far:
        assert places.shape == (0, 3)
        assert directions == pytest.approx(np.array([[0.0, 0.0, 1.0]]), abs=1e-9)


@pytest.mark.parametrize("change", ["complete", "whole", "nobody"])
def test_where_no_camera_is_known_nothing_is_hidden(flowing, run, tmp_path, change):
    if change == "complete":
        flowing = replace(flowing, smoke=replace(flowing.smoke, complete=True))
    elif change == "whole":
        flowing = replace(flowing, render=replace(flowing.render, cull=False))
    frame = 3 if change == "nobody" else 1
    found, _ = grids(bake.bake(Shot(flowing, run), frames=[frame]) / f"smoke_{frame:06d}.vdb")
    assert found["density"].activeVoxelCount() > 0
    assert "hidden" not in found or found["hidden"].activeVoxelCount() == 0


def test_a_close_picture_from_above_has_a_nest(flowing, run):
    def boxes_of(swath):
        camera = replace(flowing.cameras[0], rig=rigs.kinds()["satellite"](swath=swath))
        return len(flow.Flow(Shot(replace(flowing, cameras=(camera,)), run)).domains)

    assert boxes_of(10_000.0) == 2
    assert boxes_of(56_000.0) == 1


def test_no_box_is_wider_than_can_be_solved(shot, monkeypatch):
    monkeypatch.setattr(domains, "_WIDEST", 11_000.0)
    monkeypatch.setattr(domains, "_MARGIN", 30_000.0)
    box = flow.Flow(shot).domains[0].box
    assert max(box.shape) * box.spacing <= 12_000.0


def test_a_stopped_flow_ends(shot):
    solved = flow.Flow(shot)
    solved.stop.set()
    with pytest.raises(flow.IntegratorStoppedError):
        solved.ready(1)


def test_without_fire_there_is_an_empty_volume(flowing, run_folder, tmp_path):
    import shutil

    folder = tmp_path / "cold"
    shutil.copytree(run_folder, folder)
    np.save(folder / "heat_flux.npy", np.zeros_like(np.load(folder / "heat_flux.npy")))
    cold = Shot(replace(flowing, run=folder), runs.open(folder))
    place = bake.bake(cold, frames=[1])
    found, _ = grids(place / "smoke_000001.vdb")
    assert all(grid.activeVoxelCount() == 0 for grid in found.values())


def test_a_run_without_arrival_times_or_wind_flows(flowing, run_folder, tmp_path):
    import shutil

    folder = tmp_path / "foreign"
    shutil.copytree(run_folder, folder)
    (folder / "fuel_arrival_time.npy").unlink()
    toml = (folder / "run.toml").read_text()
    (folder / "run.toml").write_text(toml.replace('fuel_arrival_time = "s"\n', ""))
    foreign = Shot(replace(flowing, run=folder), runs.open(folder))
    assert foreign.wind == (0.0, 0.0)
    place = bake.bake(foreign, frames=[2])
    found, metadata = grids(place / "smoke_000002.vdb")
    assert found["density"].activeVoxelCount() > 0
    assert float(metadata["smoke_airborne_kg"]) > 0.0


def test_the_scene_shows_both_layers(shot, stage, scene):
    from firetwin.scene.smoke import build

    bake.bake(shot)
    build.build(shot, stage)
    scene.frame_set(2)
    volumes = {volume.name: volume for volume in bpy.data.volumes}
    assert set(volumes) == {"Firetwin Smoke", "Firetwin Far Smoke"}
    for volume in volumes.values():
        volume.grids.load()
        assert {grid.name for grid in volume.grids} >= {"density", "fresh", "sun", "sky"}
        assert volume.render.clipping <= 1.01 * flow_frames.min_extinction(
            shot.scale
        )  # else painted smoke is omitted in blocks


def test_smoke_has_all_but_gone_where_its_box_ends(shot):
    layer = flow_frames.layers(shot, flow.Flow(shot))[0]
    box = layer.domain.box
    painter = flow_frames.Painter(shot, layer, None)
    along = box.corner[0] + np.array([0.0, 600.0, 1000.0, 0.5 * (box.high[0] - box.corner[0])])
    share, drawn = painter._shares(along, np.full(4, 0.5 * (box.corner[1] + box.high[1])))
    assert np.all(drawn == 1.0)
    assert share[:2].tolist() == [0.0, 0.0]
    assert 0.0 < share[2] < 1e-5
    assert share[3] > share[2]


def test_voxels_of_smoke_are_as_fine_as_pixels_show(flowing, run, monkeypatch):
    monkeypatch.setattr(Shot, "fire_distance", 5000.0)

    def voxel(width):
        render = replace(flowing.render, resolution=(width, width // 2))
        settings = replace(flowing, smoke=replace(flowing.smoke, voxel_size=0.0), render=render)
        shot = Shot(settings, run)
        return flow_frames.layers(shot, flow.Flow(shot))[-1].voxel

    lens = 2.0 * Shot(flowing, run).perspective_paths[0].half[0]
    assert voxel(1000) == pytest.approx(4.0 * 5000.0 * lens / 1000)
    assert voxel(100) == 36.0
    assert voxel(8000) == 20.0


def test_moments_that_another_process_solves_are_waited_for(shot):
    """Snapshots are read as they appear; missing ones are solved here."""
    solver, waits = flow.Flow(shot), flow.Flow(shot)
    asked = []

    def working():
        asked.append(True)
        if len(asked) == 3:
            solver.ready(1)
        return len(asked) < 5

    waits.elsewhere = working
    waits.ready(1)
    assert len(asked) == 3
    assert waits._integrator is None
    waits.ready(2)
    assert len(asked) == 5
    assert waits.has(2)


def test_waiting_for_another_process_can_be_stopped(shot):
    waits = flow.Flow(shot)
    waits.elsewhere = lambda: True
    waits.stop.set()
    with pytest.raises(flow.IntegratorStoppedError):
        waits.ready(1)
