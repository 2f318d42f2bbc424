"""Coarse first picture: when it is drawn, and whose files it replaces."""

from types import SimpleNamespace

import pytest
from firetwin.imaging.credits import Credits
from firetwin.jobs import first_picture


@pytest.mark.parametrize(
    ("seconds", "prepared", "around", "credited", "drawn"),
    [
        (100.0, False, False, False, True),
        (1.0, False, False, False, False),
        (100.0, True, False, False, False),
        (100.0, False, True, False, False),
        (100.0, False, False, True, False),
    ],
)
def test_it_is_drawn_while_smoke_is_solved_for_long(monkeypatch, seconds, prepared, around, credited, drawn):
    """Not as a panorama, and not without required credits."""
    camera = SimpleNamespace(rig=SimpleNamespace(around=around))
    shot = SimpleNamespace(settings=SimpleNamespace(cameras=(camera,)))
    source = SimpleNamespace(is_prepared=lambda frame: prepared, cost=lambda: SimpleNamespace(first=seconds))
    monkeypatch.setattr(first_picture.sources, "select", lambda shot: source)
    words = Credits(("Agency",) if credited else ())
    monkeypatch.setattr(first_picture.picture_credits, "of_shot", lambda shot: words)
    assert first_picture.is_worthwhile(shot, 1) == drawn


def test_a_file_of_others_stays(tmp_path):
    theirs = tmp_path / first_picture.NAME
    theirs.write_text("theirs")
    assert first_picture.write(None, None, 1, tmp_path) is None
    first_picture.remove(tmp_path)
    assert theirs.read_text() == "theirs"
