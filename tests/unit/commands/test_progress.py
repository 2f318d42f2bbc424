"""Progress on a terminal and elsewhere, with a note on the last step."""

import sys

import child_work
import pytest
from firetwin import output, progress
from firetwin.jobs import first_picture, render, worker


@pytest.fixture
def clock(monkeypatch):
    """Seconds that pass when a test says so."""
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    return now


def test_plain_lines_end_with_the_note(clock, capsys):
    report = progress.Reporter()
    report(0, 4, "rendering")
    clock[0] += 60.0
    report(1, 4, "rendering", "last: out/a.png")
    clock[0] += 60.0
    report(4, 4, "rendering", "last: out/d.png")
    assert capsys.readouterr().err.splitlines() == [
        "firetwin: rendering: 0 of 4",
        "firetwin: rendering: 1 of 4, 3 min 0 s left, last: out/a.png",
        "firetwin: rendering: 4 of 4, took 2 min 0 s, last: out/d.png",
    ]


def test_a_terminal_has_the_note_after_the_bar(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", "120")
    report = progress.Reporter()
    report(0, 4, "rendering")
    report(1, 4, "rendering", "last: out/a.png")
    report.close()
    shown = capsys.readouterr().err.replace("\n", "\r").split("\r")
    assert any("1/4" in line and "last: out/a.png" in line for line in shown), shown
    assert "last" not in shown[1], "before there is one"


def test_shared_work_passes_the_note_on():
    told = []
    share = progress.share(lambda *how: told.append(how), 2, 10, "rendering")
    share(1, 3, "rendering", "last: a.png")
    share(1, 3, "building")
    progress.silent(1, 3, "rendering", "last: a.png")
    assert told == [(3, 10, "rendering", "last: a.png"), (1, 3, "building", "")]


def test_the_worker_sends_the_note(monkeypatch):
    child_work.importable(monkeypatch)
    told = []
    worker.run(child_work.report, lambda *how: told.append(how), blender=False)
    assert told == [(1, 2, "rendering", "a.png"), (2, 2)]


def test_the_first_picture_of_a_film_is_told_once(tmp_path):
    shown, told = [], []
    follow = render.picture_progress(tmp_path, lambda *how: shown.append(how), told.append)
    follow(0, 9, "building the scene")
    follow(0, 3, "rendering")
    for done in (1, 2, 3):
        follow(done, 3, "rendering", f"drone/rgb/drone_rgb_{done:06d}.png")
    first, last = (tmp_path / f"drone/rgb/drone_rgb_00000{done}.png" for done in (1, 3))
    assert told == [f"first picture: {first}; rendering continues"]
    assert shown[1] == (0, 3, "rendering", "")
    assert shown[-1] == (3, 3, "rendering", f"last: {last}")


def test_the_first_picture_replaces_the_coarse_one(tmp_path):
    coarse = tmp_path / first_picture.NAME
    output.write_text(coarse, "coarse")
    follow = render.picture_progress(tmp_path, progress.silent, progress.no_message)
    follow(0, 1, "rendering")
    assert coarse.exists()
    follow(1, 1, "rendering", "drone/rgb/drone_rgb_000001.png")
    assert not coarse.exists()


def test_a_single_picture_is_no_film(tmp_path):
    told = []
    follow = render.picture_progress(tmp_path, progress.silent, told.append)
    follow(0, 1, "rendering")
    follow(1, 1, "rendering", "drone/rgb/drone_rgb_000001.png")
    assert told == []
