"""Flames in the scene: on the front, within the budget, moving with the time."""

import shutil
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import flames
from firetwin.shot.fire import flame_noise
from firetwin.shot.sections import FireSettings
from firetwin.shot.shot import Shot


@pytest.fixture
def points(shot):
    return flames.front_flames(shot)


def placed(scene, frame):
    """Places of the flames that Blender draws in a frame."""
    scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    return np.array([i.matrix_world.translation[:] for i in graph.object_instances if i.is_instance])


def test_flame_lengths_are_those_of_the_formulas():
    assert flames.flame_length(10_000.0, "thomas") == pytest.approx(12.35, abs=0.01)
    assert flames.flame_length(10_000.0, "byram") == pytest.approx(5.36, abs=0.01)
    assert flames.flame_length(-1.0) == 0.0
    assert flames.flame_length(np.full(2, 10_000.0), "auto", np.array([True, False])) == pytest.approx(
        [12.35, 5.36], abs=0.01
    )


def test_low_flames_leave_gaps_and_tall_ones_none(shot):
    east, north = np.linspace(0.0, 4000.0, 4000), np.zeros(4000)

    def outside(length):
        scale = max(shot.front_scale, 0.3)
        return flame_noise.gap_margin(east, north, np.full(4000, length), scale, shot.settings.seed) > 0.0

    assert outside(10.0).all()
    kept = [outside(length).mean() for length in (0.4, 2.0, 4.0)]
    assert 0.3 < kept[0] < kept[1] < kept[2] < 1.0


def test_flames_lean_more_in_more_wind():
    angles = [float(flames.flame_tilt(wind, np.array(10.0))) for wind in (0.0, 3.0, 30.0)]
    assert angles[0] == 0.0
    assert angles[1] == pytest.approx(np.arctan(1.22 * 3.0 / np.sqrt(98.0665)))
    assert angles[2] <= np.pi / 3


def test_lit_flames_stand_on_the_front(points, shot, run):
    """The test fire is round: arrival = 7200 r - 600 s, so the contour's radius is known."""
    for time in shot.frames.times[1:]:
        lit = points.take(points.lit(time))
        assert len(lit.seed) > 20
        age = time - lit.arrival_time
        assert np.all((age >= 0.0) & (age < lit.residence))
        latitude, longitude, _ = shot.local_frame.reverse(lit.position)
        fuel_lat, fuel_lon = run.fuel_latitude, run.fuel_longitude
        y = np.interp(latitude, fuel_lat, np.linspace(-1, 1, len(fuel_lat)))
        x = np.interp(longitude, fuel_lon, np.linspace(-1, 1, len(fuel_lon)))
        cells = np.abs(np.hypot(x, y) - (time + 600.0) / 7200.0) * len(fuel_lat) / 2
        assert cells.max() < 1.0


def test_flames_line_the_visible_front_without_large_gaps(points, shot):
    time = shot.frames.times[1]
    lit = points.take(points.lit(time)).position[:, :2]
    gap = np.sort(np.linalg.norm(lit[:, None] - lit[None], axis=-1), axis=1)[:, 1]
    assert np.median(gap) < 25.0


def test_no_frame_has_more_flames_than_the_budget(shot, settings, run):
    full = flames.front_flames(shot)
    few = flames.front_flames(Shot(replace(settings, fire=replace(settings.fire, budget=30)), run))
    times = shot.frames.times
    counts = [len(few.lit(time)) for time in times]
    assert max(counts) <= 30 < max(len(full.lit(time)) for time in times)
    for index, (time, count) in enumerate(zip(times, counts, strict=True)):
        assert count > 0 or index == 0
        if count == 30:  # those kept are the nearest of that frame
            eye = shot.paths[0].position[index]
            near = np.sort(np.linalg.norm(full.position[full.lit(time)] - eye, axis=1))[:30]
            kept = np.linalg.norm(few.position[few.lit(time)] - eye, axis=1)
            assert kept.max() <= 1.5 * near.max()


def without_skipping(settings):
    return replace(settings, render=replace(settings.render, cull=False))


def test_flames_in_sight_are_those_that_stand_there_without_skipping(shot, settings, run):
    some, whole = flames.front_flames(shot), flames.front_flames(Shot(without_skipping(settings), run))
    seen = shot.visibility.visible_mask(whole.position, whole.length)
    assert np.sum(seen & (shot.visibility.distance(whole.position) > 2500.0)) > 100
    assert len(some.seed) < len(whole.seed)
    of_both = [
        {tuple(row) for row in np.column_stack([p.position, p.residence, p.length, p.width])}
        for p in (whole.take(np.flatnonzero(seen)), some)
    ]
    assert of_both[0] <= of_both[1]


def test_a_front_of_fewer_flames_is_as_bright(shot, monkeypatch):
    """Over the budget, flames are farther apart, and wider in proportion."""

    def light(points):
        lit = points.take(points.lit(shot.frames.times[2]))
        far = shot.visibility.distance(lit.position) > 2500.0
        return np.sum(far), np.sum((lit.width * lit.length)[far])

    many = light(flames.front_flames(shot))
    monkeypatch.setattr(flames, "_FINE", 0)
    few = light(flames.front_flames(shot))
    assert 50 < few[0] < 0.7 * many[0]
    assert few[1] == pytest.approx(many[1], rel=0.15)


def test_flames_release_the_heat_of_the_front_at_any_spacing(shot, monkeypatch):
    """Their heat is also that of the account from which smoke rises, within the difference of the methods."""

    def heat(points):
        time = shot.frames.times[2]
        return float((points.heat * flames.life((time - points.arrival_time) / points.residence)).sum())

    fine = heat(flames.front_flames(shot))
    monkeypatch.setattr(flames, "_SPACING", tuple((far, 2.0 * apart) for far, apart in flames._SPACING))
    coarse = heat(flames.front_flames(shot))
    assert coarse == pytest.approx(fine, rel=0.15)
    released = shot.fire.sources(float(shot.frames.times[2])).luminous().power.sum()
    assert 0.4 < fine / released < 2.5


def test_scrubbing_moves_the_flames(shot, stage, scene, plain_looks):
    scene.frame_end = shot.frames.count
    thing = fire.build(shot, stage)
    camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    middle, end = placed(scene, 2), placed(scene, 3)
    assert len(middle) > 20
    assert len(end) > 20
    apart = np.linalg.norm(middle[:, None, :2] - end[None, :, :2], axis=-1).min(axis=1)
    assert np.median(apart) > 200.0
    assert np.array_equal(placed(scene, 2), middle)
    assert not thing.visible_shadow


def test_flames_off_builds_nothing(settings, run, stage):
    assert fire.build(Shot(replace(settings, fire=FireSettings(flames=False)), run), stage) is None


@pytest.fixture
def quarters(run_folder, tmp_path):
    """The round fire as a model tells of it that writes fluxes each quarter of an hour, and no arrival."""
    folder = tmp_path / "quarters"
    shutil.copytree(run_folder, folder, ignore=shutil.ignore_patterns("fuel_arrival_time.npy"))
    y, x = np.meshgrid(*2 * [(np.arange(24 * 20) + 0.5) / 240 - 1], indexing="ij")
    arrival = np.where(np.hypot(x, y) < 0.6, 7200.0 * np.hypot(x, y) - 600.0, np.inf)
    times = np.arange(9) * 900.0
    lit = [np.where(time >= arrival, np.exp(np.minimum(arrival - time, 0) / 600.0), 0.0) for time in times]
    frames = np.array([each.reshape(24, 20, 24, 20).mean((1, 3)) * 5.0e4 for each in lit])
    np.save(folder / "heat_flux.npy", frames.astype(np.float32))
    toml = (folder / "run.toml").read_text().replace("interval_s = 360.0", "interval_s = 900.0\nmean_s = 0")
    (folder / "run.toml").write_text(toml.replace('fuel_arrival_time = "s"\n', ""))
    return runs.open(folder)


def test_flames_smoke_and_flux_agree_on_the_front(settings, quarters):
    """Within a cell of the model, 370 m, in the middle of intervals and in the last one."""
    shot = Shot(settings, quarters)
    points = flames.front_flames(shot)

    def radius(position):  # in cells of the model
        latitude, longitude, _ = shot.local_frame.reverse(position)
        fuel_lat, fuel_lon = quarters.fuel_latitude, quarters.fuel_longitude
        y, x = (
            np.interp(values, axis, (np.arange(len(axis)) + 0.5) / 5 - 12)
            for values, axis in ((latitude, fuel_lat), (longitude, fuel_lon))
        )
        return np.hypot(x, y)

    middle = np.hypot(*np.meshgrid(*2 * [np.arange(24) - 11.5]))
    for time in (1800.0, 2000.0, 2300.0, 3400.0, 3590.0):
        front = 12 * (time + 600.0) / 7200.0
        lit = points.lit(time)
        assert len(lit) > 20
        off = radius(points.position[lit]) - front
        assert np.abs(off).max() < 1.0
        assert abs(off.mean()) < 0.3
        roots = radius(shot.fire.cells(time - 200.0, time).position) - front
        assert len(roots) > 5
        assert np.abs(roots).max() < 1.0
        burning = shot.fire.flux.at(time) > 0.0
        assert (np.abs(middle - front)[burning != (middle < front)] < 1.0).all()


def test_flames_of_a_part_are_those_of_the_whole_that_burn_in_its_frames(settings, run):
    shot = Shot(without_skipping(settings), run)  # invisible flames too
    whole, part = flames.front_flames(shot), flames.front_flames(shot.for_frames([2]))
    burning = whole.take(whole.lit(float(shot.frames.times[1])))
    assert 0 < len(part.position) < len(whole.position)
    assert np.array_equal(part.position, burning.position)
    assert np.array_equal(part.arrival_time, burning.arrival_time)
