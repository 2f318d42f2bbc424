"""Maps of growth: burned pixels are those that the fire has reached, and the legend and scale are right."""

from dataclasses import replace

import numpy as np
import pytest
import whole_run
from firetwin.errors import InputError
from firetwin.progress import no_message, silent
from firetwin.run import info, readers, times
from firetwin.run.labels import Label
from firetwin.story import pictures
from firetwin.story.growth_map import Growth
from firetwin.story.words import SAFE, Words

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
    moments = np.linspace(900.0, 3600.0, 10)
    shown = [np.sum(growth.arrival <= time) * growth.scale**2 for time in moments]
    assert shown == pytest.approx(info.burned(growth.run, moments), rel=0.03)
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


def test_pictures_of_others_are_not_replaced(growth, tmp_path):
    own, others = tmp_path / "growth_map_000001.png", tmp_path / "growth_map_000002.png"
    moment = times.utc(growth.run, 1200.0)

    def draw(path, overwrite=False):
        run = growth.run.path
        pictures.draw_maps(run, None, "UTC", SIZE, Words(), [(path, moment)], overwrite, silent, no_message)

    draw(own)
    draw(own)
    others.write_text("mine")
    with pytest.raises(
        InputError, match="Firetwin did not write it; choose another name, or add --overwrite"
    ):
        draw(others)
    assert others.read_text() == "mine"
    draw(others, overwrite=True)
    assert others.read_bytes() == own.read_bytes()


def test_letters_are_in_the_safe_area(growth):
    row, column = np.nonzero(growth._marks > 0.5)
    for place, size in ((row, SIZE[1]), (column, SIZE[0])):
        assert SAFE * size - 1 <= place.min() < place.max() <= (1.0 - SAFE) * size + 1


def test_the_words_of_the_map_are_the_story_s(growth):
    own = replace(growth, words=Words(north="北", kilometres="キロ", metres="メートル"))
    assert np.any(own._marks != growth._marks)
    assert own._clock(0.0).split()[1] in Words().months.split()
