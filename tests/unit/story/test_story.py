"""Stories: shots that the run can give, an editable storyboard, and captions with the run's numbers."""

import json
import os
import re
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import pairwise

import numpy as np
import pytest
import small_ensemble
import whole_run
from firetwin import cli
from firetwin.auto_framing import fire_views
from firetwin.errors import InputError
from firetwin.run import info, readers, sun, times
from firetwin.shot import run_checks
from firetwin.shot.settings import Camera, Settings, scene_file
from firetwin.story import captions, choose, story_file, timeline, words
from firetwin.story.quality import QUALITIES
from firetwin.story.scenes import Scenes
from firetwin.story.storyboard import CARD

HOUR = 3600.0
BY_TIME = {"arrival", "flames", "active", "infrared", "night", "ground"}
COMPARED = ("perimeters", "what-if", "forecast")
OTHERS = ("title", "place", "growth", "satellite", "lapse", *COMPARED, "scar", "end")
PLAIN = {"flames", "night", "ground", "satellite", "lapse", *COMPARED}
"""Shots that need more than a small fire."""
STILL = {"growth", "satellite", "lapse", "scar", *COMPARED, *BY_TIME}
RUNS = {
    "ten minutes": ({"times": (0.0, 300.0, 600.0), "cell": 10.0}, PLAIN),
    "three days": (
        {"times": tuple(np.arange(0.0, 72.5 * HOUR, 6.0 * HOUR)), "speed": 0.02},
        PLAIN - {"night"},
    ),
    "night": ({"start": "2020-07-02T06:00:00Z"}, PLAIN),
    "windless": ({"wind": None}, PLAIN),
    "date line": ({"at": (-16.5, 179.999)}, PLAIN),
    "no arrival": ({"arrival": False, "fine": 2}, PLAIN),
    "wide cells": (
        {"cell": 1500.0, "speed": 3.0, "times": tuple(np.arange(0.0, 9.5 * HOUR, HOUR))},
        PLAIN - {"satellite"},
    ),
    "no fire": ({"fires": ((0.0, 0.0, 9e9),)}, STILL),
    "one time": ({"times": (0.0,), "fires": ((0.0, 0.0, -600.0),)}, STILL | {"place"}),
}
"""Options of runs, and the shots that they cannot give."""

NUMBERS = re.compile(
    r"(\d+ \w{3} \d{4} [\d:]+) UTC \| ([\d,.]+ x|real time) \| ([\d,]+) ha \(([\d,]+) acres\)"
)
"""Facts of a caption of a run in UTC: clock, speed and area."""


@pytest.fixture(autouse=True)
def near(monkeypatch):
    """Views of flames from nearby that runs have: none, unless a test adds one; a search takes seconds."""
    views = []
    monkeypatch.setattr(fire_views, "find_near_view", lambda *_: views[0] if views else None)
    return views


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
    names = [shot.name for shot in story.shots if shot.name not in BY_TIME]
    assert names == [each for each in OTHERS if each not in {*_omitted(story)}]
    begins = [
        shot.end if shot.name == "arrival" else shot.start for shot in story.shots if shot.name in BY_TIME
    ]
    assert begins == sorted(begins)
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


def test_a_satellite_has_a_picture_at_each_of_its_times(story_of):
    _, story = story_of(**RUNS["wide cells"][0], start="2020-07-01T20:03:20Z")
    shot = next(shot for shot in story.shots if shot.name == "satellite")
    (span,) = (each for each in timeline.lay_out(story) if each.shot is shot)
    moments = [shot.start.timestamp() + k * shot.step for k in range(QUALITIES["draft"].pictures(span, 24))]
    assert moments[-1] == shot.end.timestamp()
    assert all(moment % 600.0 == 0.0 for moment in moments)
    assert len(moments) == 36
    assert (shot.render_pass, shot.camera) == ("imager_short", "goes")


@pytest.mark.parametrize(
    ("at", "reason"),
    [((-16.5, 179.999), "no complete pixel of this imager (GOES West)"), ((40.0, 15.0), "no GOES satellite")],
)
def test_a_satellite_that_shows_nothing_is_omitted(at, reason, story_of):
    _, story = story_of(at=at)
    assert reason in _omitted(story)["satellite"]


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({}, "--time-lapse adds it"),
        ({"times": (0.0, HOUR)}, "shorter than 3 hours"),
        ({"cell": 6000.0, "speed": 9.0}, "too wide for smoke"),
    ],
)
def test_the_hours_of_a_long_run_give_a_time_lapse_if_it_is_asked_for(story_of, tmp_path, options, reason):
    run, story = story_of(**{"times": (0.0, 3.0 * HOUR, 6.0 * HOUR), "speed": 0.05, **options})
    assert reason in _omitted(story)["lapse"]
    if not options:
        board = choose.choose(run, tmp_path / "story.toml", lapse=True)
        (span,) = (each for each in timeline.lay_out(board) if each.shot.name == "lapse")
        assert (span.shot.start, span.shot.end) == tuple(times.utc(run, at) for at in (0.0, 6.0 * HOUR))
        settings = Scenes(board, run, QUALITIES["final"])._with_times(Settings(), span)
        assert (settings.smoke.method, settings.time.shutter, settings.time.frames) == ("preview", None, 720)


def test_observed_perimeters_are_shown_around_their_times(story_of, tmp_path):
    run, _ = story_of()
    folder = tmp_path / "run" / "observations"
    folder.mkdir()
    moments = ["2020-07-01T20:20:00Z", "2020-07-01T20:40:00Z", "2021-01-01T00:00:00Z"]
    write_perimeters(folder / "p.geojson", moments)
    story = choose.choose(run, tmp_path / "story.toml")
    shot = next(shot for shot in story.shots if shot.name == "perimeters")
    assert shot.reason == "compares the run with 2 observed perimeters"
    assert [times.seconds(run, at) for at in (shot.start, shot.end)] == pytest.approx([840.0, 2760.0])
    write_perimeters(folder / "p.geojson", ["2021-01-01T00:00:00Z"])
    story = choose.choose(run, tmp_path / "story.toml")
    assert _omitted(story)["perimeters"] == "no observed perimeter has a time of the run"


def write_perimeters(path, moments):
    """Write a square perimeter at each time."""
    ring = [[-120.6, 38.9], [-120.59, 38.9], [-120.59, 38.91], [-120.6, 38.91], [-120.6, 38.9]]
    shape = {"type": "Polygon", "coordinates": [ring]}
    features = [{"type": "Feature", "properties": {"date": moment}, "geometry": shape} for moment in moments]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))


@pytest.fixture
def compared(story_of, tmp_path):
    """A run, and a scene file with a slower run from 10 minutes later on, and with an ensemble of both."""
    run, _ = story_of()
    whole_run.write(tmp_path / "slower", cells=32, speed=0.2, start="2020-07-01T20:10:00Z")
    arrival = run.fuel_arrival_time() - 600.0
    arrival = np.where(np.isfinite(arrival), arrival, np.inf)
    grid = run.fuel_latitude, run.fuel_longitude
    small_ensemble.make(tmp_path, [arrival, 1.5 * arrival], None, None, 2400.0, grid, times.utc(run, 600.0))
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'run = "run"\n[forecast]\nensemble = "ensemble"\nmember = "00"\n'
        '[[runs]]\nname = "slower"\npath = "slower"\n'
    )
    return run, scene


def test_other_runs_and_members_of_the_scene_file_give_shots(compared, tmp_path):
    run, scene = compared
    shots = {shot.name: shot for shot in choose.choose(run, tmp_path / "story.toml", scene).shots}
    spans = {
        name: [times.seconds(run, at) for at in (shots[name].start, shots[name].end)]
        for name in ("what-if", "forecast")
    }
    assert spans == {"what-if": [600.0, 3600.0], "forecast": [600.0, 3000.0]}
    assert shots["what-if"].reason == "compares the run with slower"
    scene.write_text(scene.read_text().replace('"00"', '"01"'))
    omitted = _omitted(choose.choose(run, tmp_path / "story.toml", scene))
    assert "the run does not show member 01 of the forecast" in omitted["forecast"]


def test_the_shots_of_comparisons_have_valid_scene_files(compared, tmp_path):
    run, scene = compared
    board = choose.choose(run, tmp_path / "story.toml", scene)
    written = Scenes(board, run, replace(QUALITIES["draft"], resolution=(64, 36)))
    names = {"place", "what-if", "forecast", "scar"}
    for span in timeline.lay_out(board):
        if span.shot.name in names:
            settings = written.write(span)
            assert settings == scene_file.read(written.path(span.shot))
            run_checks.check(settings, run)
            assert len(settings.runs) == (span.shot.name == "what-if")
            assert bool(settings.forecast.ensemble) == (span.shot.name == "forecast")
            assert settings.time.frames == 9 or span.shot.name != "what-if"


def test_flames_that_a_camera_sees_from_nearby_are_shown_in_real_time_after_the_flight_to_them(
    story_of, near
):
    kind, light = fire_views.KINDS[-1], fire_views.LIGHTS[0]
    near.append(fire_views.NearView(kind, light, 1800.0, Camera("crown_400m"), 400.0))
    run, story = story_of()
    shots = {shot.name: shot for shot in story.shots}
    flames, flight = shots["flames"], shots["arrival"]
    assert (flames.camera, flames.caption, flames.speed) == ("near", "Crown run by day, from 400 m", 1.0)
    assert times.seconds(run, flames.start) == 1800.0
    assert flight.end == flames.start


def test_the_most_active_minutes_by_daylight_are_shown_though_the_night_has_more(story_of):
    options = {
        "times": tuple(np.arange(0.0, 7.5 * HOUR, HOUR)),
        "start": "2020-07-01T22:00:00Z",
        "cell": 300.0,
    }
    run, story = story_of(**options)
    active = next(shot for shot in story.shots if shot.name == "active")
    assert sun.position(run, times.seconds(run, active.end))[1] > 7.0


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


def test_a_run_on_another_drive_is_named_by_its_whole_path(story_of, monkeypatch):
    _, story = story_of()

    def other_drive(path, start):
        raise ValueError("path is on mount 'C:', start on mount 'D:'")

    monkeypatch.setattr(os.path, "relpath", other_drive)
    assert f'run = "{story.run.as_posix()}"' in story_file.text(story)


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
        ('camera = "front"', 'place = "x"', "camera is missing"),
        ('wipe_from = "active"', 'wipe_from = "scar"', "not a shot of the same camera, times and length"),
        ("fps = 24", "fsp = 24", 'mean "fps"'),
        (r"start = 20\d\d-", "start = 0001-", "outside of the years"),
    ):
        story.path.write_text(re.sub(old, new, text, count=1))
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


def test_each_number_of_the_captions_is_the_run_s(story_of, tmp_path, capsys):
    run, story = story_of(units="metric", at=(38.9, 0.1), cell=60.0)  # 0.1 E: local time is UTC
    out = tmp_path / "out"
    assert (
        cli.main(["story", str(tmp_path / "run"), "--out", str(out), "--units", "metric", "--storyboard"])
        == 0
    )
    lines = (out / "story.srt").read_text().splitlines()
    shown = [match for line in lines if (match := NUMBERS.search(line))]
    assert len(shown) > 20
    speeds = {story.words.pace(shot.speed) for shot in story.shots if shot.start}
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
    capsys.readouterr()
    assert cli.main(["info", str(tmp_path / "run"), "--json"]) == 0
    burned = json.loads(capsys.readouterr().out)["burned"]
    grown = [each["burned_area_m2"] for each in report["captions"] if each["shot"] == "growth"]
    assert grown[0] == pytest.approx(burned["first"], abs=0.1)
    assert areas[-1] == pytest.approx(burned["last"], rel=0.01)
    assert {each["text"].splitlines()[-1] for each in report["captions"]} <= {*lines}
    assert (out / "story.vtt").read_text().count(" --> ") == sum(" --> " in line for line in lines)


def test_captions_do_not_overlap_and_can_be_read(story_of):
    run, story = story_of()
    shown = captions.make(story, timeline.lay_out(story), run)
    assert all(a.end == b.first for a, b in pairwise(shown))
    assert min(each.end - each.first for each in shown) >= 12
    assert min(each.end - each.first for each in shown if each.span.shot.name != "growth") >= 24
    clock = shown[1].text.splitlines()[1].partition(" | ")[0]
    assert clock == "1 Jul 2020 12:00 -08 (20:00 UTC)"
    assert story.words.synthetic not in "".join(each.text for each in shown)


def test_captions_of_a_time_lapse_name_the_time_that_its_pictures_show(story_of):
    run, story = story_of(times=tuple(np.arange(0.0, 24.5 * HOUR, HOUR)), cell=300.0)
    spans = timeline.lay_out(story)
    shown = [each for each in captions.make(story, spans, run) if each.span.shot.name == "growth"]
    seconds = 0.75 * shown[0].span.shot.speed  # of the fire, while a caption and half of another are shown
    for each in shown:
        for frame in (each.first, each.end - 1):
            assert abs((each.span.moment(frame) - each.moment).total_seconds()) <= seconds
    now, before = shown[20], shown[16]
    rate = (now.area - before.area) / ((now.moment - before.moment).total_seconds() / HOUR)
    assert rate > 0.0
    assert now.growth == pytest.approx(rate)
    assert f"| +{words.rounded(rate / 4046.8564224)} acres an hour" in now.facts
    upper, lower = now.lines.splitlines()
    assert upper.endswith("acres an hour")
    assert lower.endswith("burned")


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


WORDS = {"burned": "{} 焼失", "speed": "{} 倍速", "hectares": "ヘクタール", "acres": "Äcker"}
MONTHS = " ".join(f"{month}月" for month in range(1, 13))


def test_all_words_of_captions_can_be_translated(story_of):
    run, story = story_of()
    story.path.parent.mkdir()
    text = story_file.text(replace(story, words=replace(story.words, months=MONTHS, **WORDS)))
    story.path.write_text(text.replace('"The place"', '"Über dem Feuer 火災"'), encoding="utf-8")
    own = story_file.read(story.path)
    shown = captions.srt(captions.make(own, timeline.lay_out(own), run), own.fps)
    assert (
        "Über dem Feuer 火災\n1 7月 2020 12:00 -08 (20:00 UTC) | real time | 0 Äcker (0 ヘクタール) 焼失"
        in shown
    )
    assert "180 倍速" in shown
    assert not re.search(r"acres|\bha\b|burned|\bJul\b", shown.split("\n2\n")[1])
    for new, fault in (('"burned"', 'must have "{}" once'), ('"{} {}"', 'must have "{}" once')):
        story.path.write_text(text.replace('"{} 焼失"', new))
        with pytest.raises(InputError, match=re.escape(fault)):
            story_file.read(story.path)


def test_every_caption_of_a_synthetic_run_says_so(make_run, tmp_path):
    run = readers.open(make_run())
    story = choose.choose(run, tmp_path / "story.toml")
    shown = captions.make(story, timeline.lay_out(story), run)
    assert all("synthetic" in each.text.lower() for each in shown)
    assert {each.moment.tzinfo for each in shown if each.moment} == {UTC}
    assert all(each.moment >= times.utc(run, 0.0) - timedelta(0) for each in shown if each.moment)


def _omitted(story):
    return {each.name: each.reason for each in story.omitted}
