"""Draws of a data set: independent of order and of other values, within ranges, and with their fire."""

import dataclasses

import numpy as np
import pytest
import small_plan
from firetwin.dataset import draws, hashing, placement
from firetwin.dataset.distributions import VALUES, Constant, LogUniform
from firetwin.dataset.draws import Drawer
from firetwin.dataset.run_scene import RunScene
from firetwin.errors import InputError
from firetwin.shot.cameras import rotation
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples


@pytest.fixture(autouse=True, scope="module")
def _clear():
    """Solve no smoke, except where a test asks for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(RunScene, "veil", lambda *_: 0.0)
        yield


VEIL = RunScene.veil


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    small_plan.write_run(folder / "a")
    near = {"distance_tower": LogUniform(800.0, 3500.0), "distance_aircraft": LogUniform(1000.0, 3000.0)}
    made = small_plan.plan(folder=folder, moments=4)
    return dataclasses.replace(made, draws={**made.draws, **near})


@pytest.fixture(scope="module")
def drawer(plan):
    return Drawer(plan)


@given(index=st.integers(1, 60), others=st.lists(st.integers(1, 60), max_size=3))
@settings(max_examples=examples(30))
def test_a_sample_drawn_alone_equals_the_sample_of_any_order(plan, drawer, index, others):
    fresh = Drawer(plan)
    fresh._scenes = drawer._scenes  # opened once
    for other in others:
        fresh.draw(other)
    assert fresh.draw(index) == drawer.draw(index)


def test_the_count_of_samples_changes_no_draw(plan, drawer):
    longer = Drawer(dataclasses.replace(plan, count=5000))
    longer._scenes = drawer._scenes
    assert longer.draw(17) == drawer.draw(17)


@given(
    index=st.integers(1, 40), name=st.sampled_from(["blur", "netd", "visibility", "sun_bearing", "exposure"])
)
@settings(max_examples=examples(30))
def test_another_distribution_of_a_value_shifts_no_other_value(plan, drawer, index, name):
    bound = VALUES[name]
    other = dataclasses.replace(plan, draws={**plan.draws, name: Constant(0.5 * (bound.low + bound.high))})
    changed = Drawer(other)
    changed._scenes = drawer._scenes
    before, after = drawer.draw(index), changed.draw(index)
    assert after.camera == before.camera
    assert {key: value for key, value in after.values.items() if key != name} == {
        key: value for key, value in before.values.items() if key != name
    }


@given(index=st.integers(1, 200))
@settings(max_examples=examples(60))
def test_values_are_within_their_distributions_and_cameras_above_ground(plan, drawer, index):
    draw, scene = drawer.draw(index), drawer.scene("a")
    for name, value in draw.values.items():
        ends = plan.draws[name].quantile(0.0), plan.draws[name].quantile(1.0)
        assert min(ends) - 1e-9 <= value <= max(ends) + 1e-9, name
    position = np.array(draw.camera.position)
    above = scene.height_above_ground(position)
    assert above >= (15.0 - 1e-6 if draw.camera.kind == "tower" else 5.0)
    place = scene.ground.frame.forward([draw.camera.latitude], [draw.camera.longitude], [draw.camera.height])[
        0
    ]
    assert np.allclose(place, position, atol=1e-3)
    assert draw.distance == pytest.approx(np.linalg.norm(position - np.array(draw.target)))


def test_the_target_of_a_mobile_camera_has_its_drawn_place_in_the_picture(plan, drawer):
    frame = drawer.scene("a").ground.frame
    for index in range(1, 40):
        draw = drawer.draw(index)
        camera = draw.camera
        if camera.kind == "tower":
            continue
        turned = rotation.turned(frame, np.array(camera.position), camera.heading, camera.tilt, camera.roll)
        ray = (np.array(draw.target) - np.array(camera.position)) @ turned
        across = np.tan(np.radians(camera.field_of_view) / 2.0)
        wanted = np.copysign(0.98, draw.values["frame_x"]) if draw.values["edge"] else draw.values["frame_x"]
        assert ray[0] / -ray[2] / across == pytest.approx(wanted, abs=2e-3)
        assert ray[1] / -ray[2] / (0.75 * across) == pytest.approx(draw.values["frame_y"], abs=2e-3)
        assert draw.distance == pytest.approx(draw.values[f"distance_{camera.kind}"], rel=1e-6)


def test_times_follow_the_kind_of_a_sample(drawer):
    scene = drawer.scene("a")
    first, last = scene.window
    for index in range(1, 60):
        draw = drawer.draw(index)
        if draw.kind == "fire":
            assert first <= draw.time <= last
            assert draw.time == drawer.moments("a")[draw.moment]
        elif draw.kind == "burned_out":
            assert (draw.moment, draw.time > last) == (draws.AFTER, True)
        else:
            assert (draw.moment, draw.since_ignition < 0.0) == (draws.BEFORE, True)
        assert draw.lamps > 0 if draw.kind == "night_lights" else draw.lamps == 0
        assert draw.sun_elevation < -6.0 or not draw.night


@pytest.mark.parametrize(("low", "high"), [(60.0, 21600.0), (60.0, 900.0)])
def test_moments_count_from_the_ignition_also_before_the_run(plan, drawer, monkeypatch, low, high):
    scene = drawer.scene("a")
    first, last = (float(time) for time in (scene.run.times[0], scene.run.times[-1]))
    monkeypatch.setitem(vars(scene), "ignition", first - 1200.0)
    monkeypatch.delitem(vars(scene), "window", raising=False)
    of_plan = {**plan.draws, "time_since_ignition": LogUniform(low, high)}
    changed = Drawer(dataclasses.replace(plan, draws=of_plan, moments=8))
    changed._scenes = {"a": scene}
    if high < 1200.0:
        with pytest.raises(InputError, match=r"time_since_ignition .* begins 1200 s after .*draws"):
            changed.moments("a")
        return
    least, most = 1200.0, last - scene.ignition
    moments = changed.moments("a")
    for k, moment in enumerate(moments):  # equal parts of what is left of the distribution
        ends = [np.exp(np.interp(part / 8, [0, 1], np.log([least, most]))) for part in (k, k + 1)]
        assert ends[0] - 1e-3 <= moment - scene.ignition <= ends[1] + 1e-3


def test_a_fire_behind_a_ridge_is_drawn_again_and_the_tries_are_counted(plan, drawer, monkeypatch):
    index = next(n for n in range(1, 40) if drawer.draw(n).kind == "fire")
    before, seen = drawer.draw(index), []

    def check_fire(*arguments, **named):
        seen.append(arguments)
        if len(seen) < 3:
            raise placement.Rejected("no fire in view")

    monkeypatch.setattr(placement, "check_fire", check_fire)
    for other in ("check", "check_trees"):
        monkeypatch.setattr(placement, other, lambda *a, **b: None)
    after = drawer.draw(index)
    assert after.attempt == 2
    assert after.rejects == ("no fire in view",) * 2
    assert draws.count_rejects([after]) == {"no fire in view": 2}
    assert (after.kind, after.camera.kind, after.run) == (before.kind, before.camera.kind, before.run)
    assert after.values["blur"] != before.values["blur"]


def test_crowns_before_the_camera_or_its_target_reject_a_camera(drawer):
    scene = drawer.scene("a")
    level = rotation.turned(scene.ground.frame, np.zeros(3), 0.0, 0.0, 0.0)

    def eye(height):
        return placement.Pose(np.array([0.0, 0.0, scene.ground.up(0.0, 0.0)[0] + height]), level)

    far = np.array([0.0, 2000.0, scene.ground.up(0.0, 2000.0)[0] + 300.0])
    placement.check_trees(scene, eye(400.0), (0.5, 0.4), far)
    with pytest.raises(placement.Rejected, match="behind trees"):
        placement.check_trees(scene, eye(15.0), (0.5, 0.4), far)
    steep = rotation.turned(scene.ground.frame, np.zeros(3), 0.0, 80.0, 0.0)
    assert scene.crowded(eye(45.0).position, steep, (0.5, 0.4), 40.0) > 0.5  # crowns of 25 m below fill it
    assert scene.crowded(eye(45.0).position, level, (0.5, 0.4), 40.0) < 0.5


def test_burned_ground_has_no_unburned_islands(plan):
    scene = RunScene(plan.run("a"))
    row, column = np.nonzero(scene.ground.burned >= 0.5)
    north = row > np.median(row)
    scene.ground.burned[row[north], column[north]] = 0.0
    found, _ = scene.ground.indices(*scene.ground.geodetic(*scene.burned[:, :2].T))
    assert len(found)
    assert (found <= np.median(row) + 0.01).all()


def test_a_camera_in_the_smoke_is_drawn_again(drawer, monkeypatch):
    scene, time = drawer.scene("a"), drawer.moments("a")[2]
    front = scene.front(time).mean(axis=0)
    level = rotation.turned(scene.ground.frame, front, 270.0, 0.0, 0.0)  # against the wind
    downwind, upwind = (front + np.array([east, 0.0, 60.0]) for east in (150.0, -2500.0))
    monkeypatch.setattr(RunScene, "veil", VEIL)
    lens = placement.Lens((0.5, 0.4), 0.0, 0.0)
    inside, outside = (scene.veil(time, eye, level, lens.half, 100.0) for eye in (downwind, upwind))
    assert (outside, inside > 0.3) == (0.0, True)
    with pytest.raises(placement.Rejected, match="in the smoke"):
        placement.check_fire(scene, placement.Pose(downwind, level), time, lens, 400.0, allow_hidden=True)


def test_a_camera_sees_its_target_through_the_air(plan, drawer):
    """Towers, and others if no place has a clear view, may film thick air without fire."""
    murky = Drawer(dataclasses.replace(plan, draws={**plan.draws, "visibility": Constant(0.01)}))
    murky._scenes = drawer._scenes
    index = next(n for n in range(1, 40) if murky.strata.of(n).kind == "fire")
    with pytest.raises(InputError, match="most often for: beyond the visibility"):
        murky.draw(index)
    thick = next(
        n for n in range(1, 80) if murky.strata.of(n).kind not in ("fire", "fog", "dust", "burned_out")
    )
    assert murky.draw(thick).visibility == 0.01


def test_a_plan_whose_cameras_all_fail_names_the_reason(plan, drawer):
    under = dataclasses.replace(plan, draws={**plan.draws, "pitch_drone": Constant(60.0)})
    blind = Drawer(under)
    blind._scenes = drawer._scenes
    index = next(n for n in range(1, 40) if blind.strata.of(n).camera == "drone")
    with pytest.raises(
        InputError, match=r"400 cameras were rejected, most often for: too close to the ground"
    ):
        blind.draw(index)


def test_the_hash_is_the_same_on_every_machine():
    assert hashing.integer(54, 137, 0, "blur") == 3714928938999944683
    assert 0.0 <= hashing.share(54, 137, 0, "blur") < 1.0


def test_hashed_numbers_are_even_and_uncorrelated():
    blur, netd = (
        np.array([hashing.share(1, index, 0, name) for index in range(4000)]) for name in ("blur", "netd")
    )
    assert np.abs(np.sort(blur) - (np.arange(4000) + 0.5) / 4000).max() < 0.03  # Kolmogorov, p < 0.001
    assert abs(np.corrcoef(blur, netd)[0, 1]) < 0.06
    assert abs(np.corrcoef(blur[1:], blur[:-1])[0, 1]) < 0.06
