"""Tracks in and out: their content, their times in the film, and damaged or hostile files."""

import contextlib
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from filmed import LEVEL, film
from firetwin import cli
from firetwin.errors import InputError, read_fault
from firetwin.run import opening as runs
from firetwin.shot import run_checks
from firetwin.shot.cameras import track
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.settings import Camera, code_fingerprint, scene_file
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis
from hypothesis import strategies as st
from hypothesis_profiles import examples

TIMES = [f"2014-09-17T04:4{i}:00Z" for i in (5, 6, 7)]  # the small run's three
PLACES = [(38.901, -120.598, 1500.0), (38.904, -120.594, 1550.0), (38.908, -120.589, 1600.0)]


def gpx(points, head=""):
    inner = "\n".join(points)
    return f'<?xml version="1.0"?>\n{head}<gpx xmlns="http://x"><trk><trkseg>\n{inner}\n</trkseg></trk></gpx>'


def point(place, time=None, ele=True):
    y, x, h = place
    more = (f"<ele>{h}</ele>" if ele else "") + (f"<time>{time}</time>" if time else "")
    return f'<trkpt lat="{y}" lon="{x}">{more}</trkpt>'


GPX = gpx([point(place, time) for place, time in zip(PLACES, TIMES, strict=True)])
CSV = "time;Lat;lon;Altitude (m)\n" + "\n".join(
    f"{t};{y};{x};{h}" for (y, x, h), t in zip(PLACES, TIMES, strict=True)
)
_COORD = "".join(f"<gx:coord>{x} {y} {h}</gx:coord>" for y, x, h in PLACES)
_WHEN = "".join(f"<when>{t}</when>" for t in TIMES)
KML = (
    '<kml xmlns="http://k" xmlns:gx="http://g"><Placemark><gx:Track><altitudeMode>absolute</altitudeMode>'
    f"{_WHEN}{_COORD}</gx:Track></Placemark></kml>"
)
LINE = "<kml><Placemark><LineString>{}<coordinates>\n{}\n</coordinates></LineString></Placemark></kml>"


@pytest.fixture
def write(tmp_path):
    def write(name, text):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@pytest.fixture
def run(make_run):
    return runs.open(make_run(**LEVEL))


def following(run, path, frames=5, **drone):
    """A shot of the whole small run, two minutes, with a drone on a track."""
    return film(run, Camera("scout", Drone(track=path, **drone)), frames=frames)


@pytest.mark.parametrize(("name", "text"), [("a.gpx", GPX), ("a.KML", KML), ("a.csv", CSV)])
def test_all_formats_say_the_same(write, run, name, text):
    found = track.read(write(name, text))
    assert list(zip(found.latitude, found.longitude, found.height, strict=True)) == PLACES
    assert not found.over_ground.any()
    assert [datetime.fromtimestamp(t, UTC).isoformat()[:16] for t in found.utc] == [t[:16] for t in TIMES]
    shot = following(run, write(name, text), 3)
    there = np.stack(shot.local_frame.reverse(shot.paths[0].position), axis=-1)
    assert there == pytest.approx(np.array(PLACES), abs=1e-7)


def test_a_line_of_kml_lies_on_the_ground_or_over_it(write, run):
    coordinates = "\n".join(f"{x},{y},{h}" for y, x, h in PLACES)
    on_ground = following(run, write("a.kml", LINE.format("", coordinates)), clearance=25.0)
    assert on_ground.local_frame.reverse(on_ground.paths[0].position)[2] == pytest.approx(1225.0, abs=0.01)
    mode = "<altitudeMode>relativeToGround</altitudeMode>"
    over = following(run, write("b.kml", LINE.format(mode, "-120.598,38.901,300 -120.589,38.908,300")))
    assert over.local_frame.reverse(over.paths[0].position)[2] == pytest.approx(1500.0, abs=0.01)


def test_a_track_without_times_is_flown_at_one_speed(write, run):
    shot = following(run, write("a.gpx", gpx([point(place) for place in PLACES])), 9)
    gone = np.linalg.norm(np.diff(shot.paths[0].position, axis=0), axis=1)
    assert gone == pytest.approx(gone.mean(), rel=0.02)


def test_parts_of_the_shot_are_what_they_say(write, run):
    rows = "\n".join(f"{at},{y},{x},{h}" for at, (y, x, h) in zip((0.0, 0.25, 1.0), PLACES, strict=True))
    shot = following(run, write("a.csv", "at,lat,lon,ele\n" + rows))
    latitude = shot.local_frame.reverse(shot.paths[0].position)[0]
    assert latitude[[0, 1, 4]] == pytest.approx([place[0] for place in PLACES])


@pytest.mark.parametrize(
    ("moments", "expected"),
    [("own", [0, 0, 0, 0.5, 1]), ("start", [0, 0.5, 1, 1, 1]), ("shot", [0, 0.25, 0.5, 0.75, 1])],
)
def test_times_are_the_runs_or_begin_with_the_shot_or_fill_it(write, run, moments, expected):
    """A minute's flight that begins a minute after the run does; five frames show its two minutes."""
    ends = [point(PLACES[0], TIMES[1]), point((*PLACES[2][:2], 1500.0), TIMES[2])]
    shot = following(run, write("a.gpx", gpx(ends)), track_times=moments)
    latitude = shot.local_frame.reverse(shot.paths[0].position)[0]
    part = (latitude - PLACES[0][0]) / (PLACES[2][0] - PLACES[0][0])
    assert part == pytest.approx(np.array(expected), abs=1e-4)


def test_times_of_another_day_are_an_error_with_a_remedy(write, run):
    path = write("a.gpx", GPX.replace("2014", "2023"))
    scene = write("scene.toml", f'[[cameras]]\nname = "scout"\ntrack = "{path.name}"\n')
    settings = scene_file.read(scene)
    with pytest.raises(InputError) as caught:
        run_checks.check(settings, run)
    assert (caught.value.path, caught.value.line) == (str(scene), 3)
    assert "follows a.gpx, which was flown 2023-09-17T04:45:00Z to" in caught.value.reason
    assert 'track_times = "start" or "shot"' in caught.value.reason
    later = replace(settings.cameras[0].rig, track_times="start")
    run_checks.check(replace(settings, cameras=(Camera("scout", later),)), run)


def test_a_place_off_the_ground_is_an_error(write, run):
    scene = write("scene.toml", '[[cameras]]\nname = "scout"\ntrack = "a.gpx"\n')
    write("a.gpx", GPX.replace("38.908", "48.908"))
    with pytest.raises(InputError, match=r'scene.toml:3:1: camera "scout" is at 48.908 N'):
        run_checks.check(scene_file.read(scene), run)


BAD = {
    "bomb": (
        "a.gpx",
        GPX.replace("<gpx", '<!DOCTYPE g [<!ENTITY a "x"><!ENTITY b "&a;&a;">]><gpx'),
        2,
        "DOCTYPE",
    ),
    "outside": ("a.kml", '<!DOCTYPE k SYSTEM "file:///etc/passwd"><kml/>', 1, "DOCTYPE"),
    "cut": ("a.gpx", GPX[:200], 4, "not whole XML"),
    "no xml": ("a.gpx", b"\xff\xfe\x00\x01PK", 1, "not whole XML"),
    "encoding": ("a.gpx", GPX.replace('version="1.0"', 'version="1.0" encoding="no-such"'), 1, "XML"),
    "empty": ("a.gpx", "<gpx/>", 0, "contains no track"),
    "empty csv": ("a.csv", "", 1, "names no column latitude"),
    "nan": ("a.gpx", GPX.replace('"38.904"', '"nan"'), 4, 'the lat is "nan", which is not a number'),
    "lacking": ("a.gpx", GPX.replace('lat="38.904" ', ""), 4, "the lat is"),
    "pole": ("a.gpx", GPX.replace("38.904", "98.904"), 4, "is not a latitude"),
    "back": (
        "a.gpx",
        gpx([point(PLACES[0], TIMES[1]), point(PLACES[1], TIMES[0])]),
        4,
        "put the points in order",
    ),
    "same": (
        "a.gpx",
        gpx([point(PLACES[0], TIMES[1]), point(PLACES[1], TIMES[1])]),
        4,
        "put the points in order",
    ),
    "some times": ("a.gpx", gpx([point(PLACES[0], TIMES[1]), point(PLACES[1])]), 4, "without a time"),
    "some heights": ("a.gpx", gpx([point(PLACES[0]), point(PLACES[1], ele=False)]), 4, "without a height"),
    "time": ("a.gpx", GPX.replace(TIMES[1], "yesterday"), 4, '"yesterday" is not a time such as'),
    "counts": (
        "a.kml",
        KML.replace(f"<when>{TIMES[0]}</when>", ""),
        1,
        "2 times <when> and 3 places <gx:coord>",
    ),
    "swapped": ("a.kml", LINE.format("", "-120.6,38.9,3\n38.9,-120.6,3"), 3, "is not a latitude"),
    "columns": ("a.csv", "a,b\n1,2", 1, "names no column latitude"),
    "cell": ("a.csv", CSV.replace("38.904", "38,904"), 3, 'the latitude is "38,904"'),
    "short": ("a.csv", CSV + "\n" + TIMES[2], 5, "the latitude is"),
    "zone": ("a.csv", CSV.replace(":46:00Z", ":46:00"), 3, "is not a time such as"),
    "at": ("a.csv", "at,lat,lon\n0,38.9,-120.6\n2,38.9,-120.5", 3, "from 0 (first frame) to 1"),
    "mixed": (
        "a.csv",
        f"time,at,lat,lon\n{TIMES[0]},,38.9,-120.6\n,1,38.9,-120.5",
        3,
        "some points have a time and others a part of the shot",
    ),
    "latin": ("a.csv", CSV.replace("(m)", "(\xe9)").encode("latin-1"), 0, "UTF-8"),
    "kind": ("a.fit", "", 0, ".gpx, .kml or .csv"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_one_error_at_its_line(write, name):
    file_name, text, line, words = BAD[name]
    path = write(file_name, text)
    with pytest.raises(InputError) as caught:
        track.read(path)
    assert (caught.value.path, caught.value.line) == (str(path), line), caught.value
    assert words in caught.value.reason


def test_a_missing_track_and_a_folder_are_errors(tmp_path):
    with pytest.raises(InputError, match=r"gone.gpx: no such track"):
        track.read(tmp_path / "gone.gpx")
    (tmp_path / "b.gpx").mkdir()
    with pytest.raises(InputError, match="is a folder; name a file"):
        track.read(tmp_path / "b.gpx")


def test_a_folder_without_permission_is_a_folder(tmp_path):
    """As which Windows refuses to open it."""
    assert read_fault(PermissionError(13, "Permission denied", str(tmp_path))) == "is a folder; name a file"


@given(st.binary(max_size=300), st.sampled_from(["gpx", "kml", "csv"]))
@hypothesis(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=examples(60)
)
def test_any_bytes_are_a_track_or_an_error(tmp_path, data, kind):
    path = tmp_path / f"any.{kind}"
    path.write_bytes(data)
    track._read.cache_clear()
    with contextlib.suppress(InputError):
        assert len(track.read(path).latitude)


def test_a_point_written_twice_counts_once(write):
    twice = gpx([point(PLACES[0], TIMES[0])] * 2 + [point(PLACES[1], TIMES[1])])
    assert len(track.read(write("a.gpx", twice)).utc) == 2


def test_what_is_exported_and_flown_again_is_the_same_track(make_run, write, tmp_path, capsys):
    """Over rough ground, banking and lifted by its clearance: places within a tenth of a millimetre."""
    make_run()
    text = (
        'run = "run"\n[time]\nframes = 31\n[terrain]\napron = 3000.0\n[forest]\ntrees = false\n'
        '[[cameras]]\nname = "first"\nclearance = 40.0\nbank = 1.0\n'
        "[[cameras.keys]]\nat = 0.0\nlatitude = 38.8995\nlongitude = -120.599\nheight = 60.0\n"
        "target_latitude = 38.905\ntarget_longitude = -120.59\n"
        "[[cameras.keys]]\nat = 1.0\nlatitude = 38.9085\nlongitude = -120.587\nheight = 60.0\n"
        "target_latitude = 38.905\ntarget_longitude = -120.59\n"
    )
    again = text + '[[cameras]]\nname = "again"\ntrack = "one.gpx"\nclearance = 40.0\n'
    one, two = tmp_path / "one.gpx", tmp_path / "two.gpx"
    first = str(write("scene.toml", text))
    assert cli.main(["track", first, "--out", str(one)]) == 0
    second = str(write("again.toml", again))
    assert cli.main(["track", second, "--camera", "again", "--out", str(two)]) == 0
    assert capsys.readouterr().out.split() == [str(one), str(two)]
    a, b = track.read(one), track.read(two)
    assert np.array_equal(a.utc, b.utc)
    assert len(a.utc) == 31
    for name, within in (("latitude", 2e-9), ("longitude", 2e-9), ("height", 2e-4)):
        assert getattr(a, name) == pytest.approx(getattr(b, name), abs=within)
    assert cli.main(["track", first, "--out", str(tmp_path / "one.txt")]) == 2
    assert cli.main(["track", first, "--camera", "none", "--out", str(one)]) == 2


def test_another_track_makes_other_pictures(write):
    path = write("a.gpx", GPX)
    cameras = [Camera("scout", Drone(track=path))]
    before = code_fingerprint.hashes((), cameras)
    assert before == code_fingerprint.hashes((), cameras)
    path.write_text(GPX.replace("1550.0", "1551.0"))
    assert before != code_fingerprint.hashes((), cameras)
