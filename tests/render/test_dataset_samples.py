"""Samples of data sets: maps that agree with one another, and do not depend on the samples before."""

import dataclasses

import numpy as np
import pytest
import small_plan
from firetwin.dataset import places, render_samples
from firetwin.dataset.distributions import Constant, LogUniform
from firetwin.dataset.draws import Drawer
from firetwin.geometry.grids import dilate
from firetwin.passes import masks

LABELS = ("classes", "surface", "instance", "depth", "range", "clear", "smoke_range", "kelvin")


@pytest.fixture(scope="module")
def rendered(tmp_path_factory):
    """Render a visit of three samples, then the last of them alone: plan, draws, and both results."""
    folder = tmp_path_factory.mktemp("runs")
    small_plan.write_run(folder / "a")
    plan = small_plan.plan(folder=folder, moments=1, count=40, resolution=(64, 48), positives=1.0, night=0.3)
    near = {
        "distance_tower": LogUniform(800.0, 2000.0),
        "distance_aircraft": LogUniform(1000.0, 2500.0),
        "time_since_ignition": Constant(900.0),
    }
    plan = dataclasses.replace(plan, draws={**plan.draws, **near})
    drawer = Drawer(plan)
    drawn = [drawer.draw(index) for index in range(1, plan.count + 1)]
    (night,) = [each for each in drawn if each.night][:1]
    visit = places.Visit((*[each for each in drawn if not each.night][:2], night))
    patch = pytest.MonkeyPatch()
    patch.setattr(places, "_TREES", 3000)
    patch.setattr(places, "_CELLS", 0.1)
    try:
        batch = dict(_by_number(plan, visit, [each.index for each in visit.draws]))
        alone = dict(_by_number(plan, visit, [night.index]))
    finally:
        patch.undo()
    return visit, batch, alone


def _by_number(plan, visit, wanted):
    for draw, found in render_samples.render(plan, visit, wanted):
        yield draw.index, found


def test_a_sample_rendered_alone_has_the_same_bytes_as_in_a_batch(rendered):
    _, batch, alone = rendered
    (number,) = alone
    for name in (*LABELS, "rgb", "twin", "light", "fire"):
        assert getattr(alone[number], name).tobytes() == getattr(batch[number], name).tobytes(), name


def test_the_twin_has_no_smoke_and_the_same_surfaces(rendered):
    _, batch, _ = rendered
    for each in batch.values():
        free = ~dilate(each.clear <= 0.9999, 2)  # highlights spread by a pixel
        np.testing.assert_allclose(each.light[free], each.twin_light[free], atol=2e-2 * each.twin_light.max())
    smoky = max(batch.values(), key=lambda each: float(each.alpha.sum()))
    assert (smoky.alpha > 0.2).any()
    hidden = smoky.alpha > 0.2
    assert np.abs(smoky.rgb - smoky.twin)[hidden].max() > 0.02
    assert np.isfinite(smoky.smoke_range[hidden]).all()
    assert (smoky.smoke_range[hidden] <= smoky.range[hidden] * 1.2).mean() > 0.95


def test_classes_depth_and_temperatures_agree(rendered):
    _, batch, _ = rendered
    for each in batch.values():
        sky = each.surface == masks.SKY
        assert np.array_equal(sky & ~(each.surface == masks.FIRE), sky)
        assert np.isinf(each.depth[sky]).all()
        assert np.isfinite(each.depth[(each.surface == masks.GROUND) | (each.surface == masks.TREE)]).all()
        met = np.isfinite(each.depth)
        assert (each.range[met] >= each.depth[met] * 0.9999).all()
        assert (each.instance[each.surface == masks.TREE] > 0).all()
        assert (each.kelvin > 150.0).all()
        assert (each.kelvin < 1500.0).all()


def test_the_camera_projects_the_target_to_its_drawn_place(rendered):
    visit, batch, _ = rendered
    for draw in visit.draws:
        camera = batch[draw.index].camera
        to_camera = np.linalg.inv(camera.to_world)
        x, _, z, _ = to_camera @ [*draw.target, 1.0]
        across = camera.cx - camera.fx * x / z
        assert across == pytest.approx(32.0 + 32.0 * _place(draw), abs=0.6)


def _place(draw):
    """Drawn place of the target, -1 to 1 from left to right."""
    return (
        float(np.copysign(0.98, draw.values["frame_x"]))
        if draw.values["edge"] >= 0.5
        else draw.values["frame_x"]
    )
