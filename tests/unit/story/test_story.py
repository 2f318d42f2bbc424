"""Stories: shots that the run can give, an editable storyboard, and captions with the run's numbers."""

import json
import re
from datetime import UTC, datetime, timedelta
from itertools import pairwise

import numpy as np
import pytest
import whole_run
from firetwin import cli
from firetwin.errors import InputError
from firetwin.run import info, readers, times
from firetwin.story import captions, choose, story_file, timeline
from firetwin.story.storyboard import CARD

HOUR = 3600.0
ALL = ("title", "place", "growth", "arrival", "active", "infrared", "ground", "scar", "end")
STILL = {"growth", "arrival", "active", "infrared", "ground", "scar"}
RUNS = {
    "ten minutes": ({"times": (0.0, 300.0, 600.0), "cell": 10.0}, {"ground"}),
    "three days": ({"times": tuple(np.arange(0.0, 72.5 * HOUR, 6.0 * HOUR)), "speed": 0.02}, {"ground"}),
    "night": ({"start": "2020-07-02T06:00:00Z"}, {"ground"}),
    "windless": ({"wind": None}, {"ground"}),
    "date line": ({"at": (-16.5, 179.999)}, {"ground"}),
    "no fire": ({"fires": ((0.0, 0.0, 9e9),)}, STILL),
    "one time": ({"times": (0.0,), "fires": ((0.0, 0.0, -600.0),)}, STILL | {"place"}),
}
"""Options of runs, and the shots that they cannot give."""

NUMBERS = re.compile(
    r"(\d+ \w{3} \d{4} [\d:]+) UTC \| ([\d,.]+ x|real time) \| ([\d,]+) ha \(([\d,]+) acres\)"
)
"""Facts of a caption of a run in UTC: clock, speed and area."""


@pytest.fixture
def story_of(tmp_path):
    """Return a function that writes a run, and returns it with its storyboard."""

    def write(places="", units="us", **options):
        run = readers.open(whole_run.write(tmp_path / "run", **{"cells": 32, **options}))
        table = None
        if places:
            table = tmp_path / "places.csv"
            table.write_text(f"name,latitude,longitude\n{places}")
        return run, choose.choose(run, tmp_path / "out" / "story.toml", None, table, units)

    return write


@pytest.mark.parametrize("name", RUNS)
def test_a_run_gives_the_shots_that_it_can_and_reasons_for_the_others(name, story_of):
    options, absent = RUNS[name]
    run, story = story_of(**options)
    assert [shot.name for shot in story.shots] == [each for each in ALL if each not in {*_omitted(story)}]
    assert absent - {"arrival"} == {*_omitted(story)} - {"arrival"}
    assert all(each.reason for each in (*story.shots, *story.omitted))
    first, last = (times.utc(run, float(run.times[i])) for i in (0, -1))
    for shot in story.shots:
        assert shot.picture == CARD or first <= shot.start < shot.end <= last, shot
    text = "".join(shot.caption for shot in story.shots if shot.name != "place")
    assert "by night" in text or name != "night"
    assert "by daylight" in text or name != "ten minutes"
    assert ("180.00° E" in text) == (name == "date line")
    if "growth" not in absent:
        shown = next(shot for shot in story.shots if shot.name == "growth")
        assert (shown.start, shown.end) == (first, last)


def test_a_place_near_the_fire_gives_a_shot_from_it(story_of):
    run, story = story_of(places="Far,40,-120\nNear,38.9,-120.597\n")
    shot = next(shot for shot in story.shots if shot.name == "ground")
    assert (shot.place, shot.reason) == ("Near", "shows how the fire reaches it")
    arrives = np.hypot(*whole_run_metres(run, 38.9, -120.597)) / 0.3  # along the wind
    assert times.seconds(run, shot.end) == pytest.approx(arrives, abs=60.0)


def whole_run_metres(run, latitude, longitude):
    """Metres north and east of a place from the middle of a run."""
    north, east = (float(axis.mean()) for axis in (run.latitude, run.longitude))
    scale = 111e3 * np.array([1.0, np.cos(np.radians(north))])
    return scale * (latitude - north, longitude - east)


def test_the_file_comes_back_and_names_faults(story_of):
    _, story = story_of()
    story.path.parent.mkdir()
    text = story_file.text(story)
    story.path.write_text(text)
    again = story_file.read(story.path)
    assert [*map(_plain, again.shots)] == [*map(_plain, story.shots)]
    assert again.path == story.path
    assert (again.run.resolve(), again.omitted) == (story.run.resolve(), story.omitted)
    for old, new, fault in (
        ('picture = "map"', 'picture = "mop"', '"map"'),
        ("seconds = 20.0", "seconds = 0.0", "from 0.5 to 600"),
        ('name = "scar"', 'name = "end"', 'two shots are called "end"'),
        ('camera = "chase"', 'place = "x"', "camera is missing"),
        ("fps = 24", "fsp = 24", 'mean "fps"'),
    ):
        story.path.write_text(text.replace(old, new, 1))
        with pytest.raises(InputError, match=re.escape(fault)) as error:
            story_file.read(story.path)
        assert str(error.value).startswith(f"{story.path}:"), error


def _plain(shot):
    """Return the values of a shot, with times to the millisecond, as the file has them."""
    return [
        value.timestamp().__round__(2) if isinstance(value, datetime) else value
        for value in vars(shot).values()
    ]


def test_shots_follow_one_another_and_dissolve(story_of):
    _, story = story_of()
    spans = timeline.lay_out(story)
    assert spans[0].first == 1
    assert all(b.first == a.end - 12 for a, b in pairwise(spans))  # half a second
    assert timeline.frames(spans) == sum(24 * shot.seconds for shot in story.shots) - 12 * (len(spans) - 1)
    shown = next(span for span in spans if span.shot.name == "growth")
    assert shown.moment(shown.first) == shown.shot.start
    assert shown.moment(shown.end - 1) == shown.shot.end


def test_each_number_of_the_captions_is_the_run_s(story_of, tmp_path):
    run, story = story_of(units="metric", at=(38.9, 0.1), cell=60.0)  # 0.1 E: local time is UTC
    out = tmp_path / "out"
    assert (
        cli.main(["story", str(tmp_path / "run"), "--out", str(out), "--units", "metric", "--storyboard"])
        == 0
    )
    lines = (out / "story.srt").read_text().splitlines()
    shown = [match for line in lines if (match := NUMBERS.search(line))]
    assert len(shown) > 20
    speeds = {captions.speed_text(shot.speed) for shot in story.shots if shot.start}
    areas = []
    for match in shown:
        clock = match[1] if match[1].count(":") == 2 else f"{match[1]}:00"
        moment = datetime.strptime(clock, "%d %b %Y %H:%M:%S").replace(tzinfo=UTC)
        (area,) = info.burned(run, [times.seconds(run, moment)])
        assert match[3] == f"{area / 1e4:,.0f}"
        assert match[4] == f"{area / 4046.8564224:,.0f}"
        assert match[2] in speeds
        areas.append(area)
    assert len({*areas}) > 10
    assert max(areas) > 10.0 * areas[0]
    report = json.loads((out / "story.json").read_text())
    assert [each["burned_area_m2"] for each in report["captions"]] == pytest.approx(areas, abs=0.1)
    assert report["area"]["field"] == "fuel_arrival_time"
    assert {each["text"].splitlines()[-1] for each in report["captions"]} <= {*lines}
    assert (out / "story.vtt").read_text().count(" --> ") == sum(" --> " in line for line in lines)


def test_captions_do_not_overlap_and_can_be_read(story_of):
    run, story = story_of()
    shown = captions.make(story, timeline.lay_out(story), run)
    assert all(a.end == b.first for a, b in pairwise(shown))
    assert min(each.end - each.first for each in shown) >= 24
    clock = shown[1].text.splitlines()[1].partition(" | ")[0]
    assert clock == "1 Jul 2020 12:00 -08 (20:00 UTC)"
    assert captions.SYNTHETIC not in "".join(each.text for each in shown)


def test_the_storyboard_of_the_folder_is_used_again(story_of, tmp_path, capsys):
    story_of()
    out, words = (
        tmp_path / "out",
        ["story", str(tmp_path / "run"), "--out", str(tmp_path / "out"), "--storyboard"],
    )
    assert cli.main(words) == 0
    path = out / "story.toml"
    path.write_text(path.read_text().replace("Growth, by hour of arrival", "How it grew"))
    assert cli.main(words) == 0
    assert "How it grew" in (out / "story.srt").read_text()
    assert "omitted: ground: no town" in capsys.readouterr().err
    assert cli.main([*words, "--overwrite"]) == 0
    assert "How it grew" not in path.read_text()


def test_every_caption_of_a_synthetic_run_says_so(make_run, tmp_path):
    run = readers.open(make_run())
    story = choose.choose(run, tmp_path / "story.toml")
    shown = captions.make(story, timeline.lay_out(story), run)
    assert all("synthetic" in each.text.lower() for each in shown)
    assert {each.moment.tzinfo for each in shown if each.moment} == {UTC}
    assert all(each.moment >= times.utc(run, 0.0) - timedelta(0) for each in shown if each.moment)


def _omitted(story):
    return [each.name for each in story.omitted]
