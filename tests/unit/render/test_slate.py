"""The slate's layout: texts stay inside the picture, in each eye, and do not overlap."""

import pytest
from firetwin.imaging import slate

ROWS = [["", "King Fire v003"], ["Shot", "drone, rgb"], ["Run", "a very long name " * 20], ["", "SYNTHETIC"]]


def measure(text, size):
    return 0.6 * size * len(text)


@pytest.mark.parametrize(("width", "height"), [(640, 360), (96, 160), (1920, 1080)])
def test_rows_follow_each_other_inside_the_picture(width, height):
    places = slate.lay_out(ROWS, width, height, False, measure)
    texts = [place.text for place in places]
    assert texts == ["King Fire v003", "Shot", "drone, rgb", "Run", ROWS[2][1], "SYNTHETIC"]
    for place in places:
        assert place.left >= 0.0
        assert place.left + measure(place.text, place.size) <= width
        assert 0.0 <= place.base <= height - place.size
    title, label, shot, run, name, warning = places
    assert title.size > label.size == shot.size > name.size
    assert title.base > shot.base > run.base > warning.base + warning.size
    assert label.base == shot.base
    assert label.left + measure("Shot", label.size) < shot.left


def test_each_eye_shows_the_rows():
    flat = slate.lay_out(ROWS, 512, 512, True, measure)
    assert len(flat) == 2 * 6
    for lower, upper in zip(flat[:6], flat[6:], strict=True):
        assert upper == lower._replace(base=lower.base + 256)
        assert lower.base + lower.size < 256
        assert lower.left + measure(lower.text, lower.size) <= 0.62 * 512 + 1e-6
