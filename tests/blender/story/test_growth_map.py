"""Maps of growth: burned pixels are those that the fire has reached, and the legend and scale are right."""

import numpy as np
import pytest
import whole_run
from firetwin.run import info, readers, times
from firetwin.run.labels import Label
from firetwin.story import growth_map
from firetwin.story.growth_map import Growth

SIZE = (160, 90)


@pytest.fixture(scope="module")
def growth(factory, tmp_path_factory):
    run = readers.open(whole_run.write(tmp_path_factory.mktemp("growth") / "run", cells=48, wind=None))
    north = float(run.latitude.mean())
    places = [Label("In", north, float(run.longitude.mean())), Label("Far", north + 0.01, -120.6)]
    return Growth(run, places, "UTC", SIZE)


def _at(growth, time):
    return growth.draw(times.utc(growth.run, time))


def test_the_coloured_area_is_the_burned_area(growth):
    for time in (1200.0, 3600.0):
        (area,) = info.burned(growth.run, [time])
        shown = np.sum(growth.arrival <= time) * growth.scale**2
        assert shown == pytest.approx(area, rel=0.03)
    changed = np.any(_at(growth, 3600.0) != _at(growth, 1200.0), axis=-1)
    burning = growth.arrival <= 3600.0
    assert not changed[~burning].any()
    assert changed[(growth.arrival > 1300.0) & burning].mean() > 0.95


def test_the_fire_fits_above_the_captions(growth):
    row, column = np.nonzero(np.isfinite(growth.arrival))
    assert 0.1 * SIZE[1] < row.min() < row.max() < 0.85 * SIZE[1]
    assert row.max() - row.min() > 0.55 * SIZE[1]
    assert 0.1 * SIZE[0] < column.min() < column.max() < 0.9 * SIZE[0]


def test_names_turn_white_as_the_fire_reaches_them(growth):
    ((arrives, letters),) = growth._names[:1]
    assert arrives < 120.0
    before, after = (_at(growth, time)[letters > 0.9].mean() for time in (-1.0, 600.0))
    assert before < 0.8 < 0.95 < after


def test_the_scale_bar_is_a_round_length():
    assert [growth_map._round_length(most) for most in (730.0, 2100.0, 19999.0)] == [500.0, 2000.0, 10000.0]
