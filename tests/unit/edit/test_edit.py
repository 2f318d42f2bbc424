"""Edits: one cut in OTIO, XML and EDL, whose frames exist; markers at the times of their events."""

import xml.etree.ElementTree as ET
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from urllib.parse import unquote

import opentimelineio as otio
import pytest
from firetwin import cli, output, timecode
from firetwin.cuts import cut, edl, fcp_xml
from firetwin.cuts import otio as otio_file
from firetwin.cuts.cut import CameraFilm, Edit, Marker
from firetwin.render import store
from firetwin.render.picture import Picture, film
from firetwin.render.store import Store
from hypothesis import given
from hypothesis import strategies as st

COUNT = 48
FRAMES = {
    "chase": [*range(1, 31), *range(35, COUNT + 1)],
    "chase-2": [*range(5, COUNT + 1)],
    "north-side": [*range(1, 20), *range(41, 45)],
    "all-round": [*range(1, COUNT + 1)],
}
CUT = {
    "chase": [*range(1, 17), *range(35, 41), *range(45, COUNT + 1)],
    "chase-2": [*range(17, 35)],
    "north-side": [41, 42, 43, 44],
}
"""Parts of 16 frames; in the last, north-side has 41 to 44 alone, chase follows it, and then chase-2."""

SCENE = """\
run = "run"
time = { frames = 48, fps = FPS }
labels = { file = "places.csv" }
"""
CAMERA = """
[[cameras]]
name = "{}"
{}keys = [{{ latitude = 38.904, longitude = -120.59, height = 150.0, target = "head" }}]
"""
PANORAMA = 'kind = "vr"\nresolution = [64, 64]\n'


@pytest.fixture
def rendered(make_run, tmp_path):
    """Return a function that writes a scene and made-up finished files; it returns the scene file."""

    def write(fps="24", rate="24", kinds=("review", "clean")):
        scene, out = make_run().parent / "scene.toml", tmp_path / "my film"
        cameras = (CAMERA.format(name, PANORAMA * (name == "all-round")) for name in FRAMES)
        scene.write_text(SCENE.replace("FPS", fps) + "".join(cameras))
        (tmp_path / "places.csv").write_text("name,latitude,longitude\nHere,38.903,-120.592\nFar,38,-121\n")
        with Store(out, create=True) as film_store:
            for camera, frames in FRAMES.items():
                names = ("rgb", "comp") if camera != "chase-2" else ("rgb",)
                for name in names:
                    _add(
                        film_store,
                        {"run": {}},
                        camera,
                        name,
                        {Picture(camera, f, name).file("exr"): f for f in frames},
                    )
                for kind in kinds:
                    made_from = {
                        "film": "rgb",
                        "kind": kind,
                        "fps": rate,
                        "frames": [[f, ""] for f in frames],
                    }
                    _add(film_store, made_from, camera, "rgb", {film(camera, "rgb", kind): None}, film=kind)
            film_store.export()
        return scene

    return write


def _add(film_store, settings, camera, name, frames, **more):
    for path in frames:
        (film_store.out / path).parent.mkdir(parents=True, exist_ok=True)
        (film_store.out / path).write_bytes(b"")
    entries = {
        path: {"camera": camera, "pass": name, **more}
        | ({} if frame is None else {"frame": frame})
        | store.describe(film_store.out / path)
        for path, frame in frames.items()
    }
    film_store.add(settings | {"camera": camera}, entries)


def played(timeline, key="DEFAULT_MEDIA"):
    """Play a timeline: for each frame from 1, its media (a film and position, or a picture), or None."""
    track = [each for each in timeline.video_tracks() if each.enabled][-1]
    shown = []
    for item in track:
        times = item.trimmed_range()
        if isinstance(item, otio.schema.Gap):
            shown += [None] * round(times.duration.value)
            continue
        reference = item.media_references().get(key)
        for k in range(round(times.duration.value)):
            time = times.start_time + otio.opentime.RationalTime(k, times.start_time.rate)
            if reference is None:
                shown.append(None)
                continue
            assert reference.available_range.contains(time)
            if isinstance(reference, otio.schema.ImageSequenceReference):
                number = reference.frame_for_time(time) - reference.start_frame
                shown.append(unquote(reference.target_url_for_image_number(number)))
            else:
                position = round((time - reference.available_range.start_time).value)
                shown.append((unquote(reference.target_url), position))
    return shown


def media(timeline):
    """Return file, source range and position of each clip of the first track."""
    track = timeline.video_tracks()[0]
    first = min(track.range_of_child(clip).start_time for clip in track.find_clips())
    return [
        (
            clip.media_reference.target_url,
            *(
                round(value)
                for value in (clip.source_range.start_time.value, clip.source_range.duration.value)
            ),
            round((track.range_of_child(clip).start_time - first).value),
        )
        for clip in track.find_clips()
    ]


def test_a_cut_of_three_cameras_plays_frames_that_exist(rendered, tmp_path, capsys):
    scene, out = rendered(), tmp_path / "edits" / "one"
    assert cli.main(["edit", str(scene), "--film", str(tmp_path / "my film"), "--out", str(out)]) == 0
    done = capsys.readouterr()
    assert [Path(line).name for line in done.out.split("\n")[:3]] == ["film.otio", "film.xml", "film.edl"]
    assert "cameras without a film: all-round" in done.err
    timeline = otio.adapters.read_from_file(str(out / "film.otio"))
    assert timeline.global_start_time.to_timecode() == "01:00:00:00"
    assert [(each.name, each.enabled) for each in timeline.tracks] == [
        ("V1", True),
        *((name, False) for name in list(FRAMES)[:3]),
    ]
    assert timeline.video_tracks()[0][0].media_reference.target_url.startswith("../../my%20film/")
    camera_of = {frame: camera for camera, frames in CUT.items() for frame in frames}
    shown = played(timeline)
    assert len(shown) == COUNT
    for frame, (path, position) in enumerate(shown, 1):
        camera = camera_of[frame]
        assert (out / path).resolve() == tmp_path / "my film" / film(camera, "rgb", "clean")
        assert FRAMES[camera][position] == frame
        assert (out / path).is_file()
    for key in ("rgb", "comp"):
        for frame, path in enumerate(played(timeline, key), 1):
            camera = camera_of[frame]
            if (camera, key) == ("chase-2", "comp"):
                assert path is None
                continue
            assert (out / path).resolve() == tmp_path / "my film" / Picture(camera, frame, key).file("exr")
            assert (out / path).is_file()


def test_tracks_of_cameras_are_in_step(rendered, tmp_path):
    out = tmp_path / "my film"
    assert cli.main(["edit", str(rendered()), "--out", str(out)]) == 0
    timeline = otio.adapters.read_from_file(str(out / "film.otio"))
    for track in timeline.tracks[1:]:
        alone = otio.schema.Timeline()
        track = track.deepcopy()
        track.enabled = True
        alone.tracks.append(track)
        got = {frame: each for frame, each in enumerate(played(alone), 1) if each}
        assert got == {
            frame: (film(track.name, "rgb", "clean"), position)
            for position, frame in enumerate(FRAMES[track.name])
        }


@pytest.mark.parametrize(("fps", "rate"), [("24", "24"), ("23.976", "24000/1001"), ("29.97", "30000/1001")])
def test_xml_and_edl_give_the_same_cut(rendered, tmp_path, fps, rate):
    out, frames_per_second = tmp_path / "my film", float(Fraction(rate))
    assert cli.main(["edit", str(rendered(fps, rate)), "--out", str(out)]) == 0
    whole = otio.adapters.read_from_file(str(out / "film.otio"))
    xml = otio.adapters.read_from_file(str(out / "film.xml"), "fcp_xml")
    lines = otio.adapters.read_from_file(str(out / "film.edl"), "cmx_3600", rate=frames_per_second)
    assert media(xml) == media(lines) == media(whole)
    assert xml.global_start_time == whole.global_start_time
    assert [each.name for each in xml.tracks] == [each.name for each in whole.tracks]
    for a, b in zip(xml.tracks, whole.tracks, strict=True):
        assert [each.trimmed_range() for each in a] == [each.trimmed_range() for each in b]
    marks = [(each.name, round(each.marked_range.start_time.value)) for each in whole.tracks.markers]
    assert marks
    assert [(each.name, round(each.marked_range.start_time.value)) for each in xml.tracks.markers] == marks
    text = (out / "film.edl").read_text()
    assert "01:00:00;00" in text if fps == "29.97" else "01:00:00:00" in text
    if fps != "29.97":  # the adapter reads no drop-frame locators
        start = timecode.count_of_frame(1, Fraction(rate))
        found = [m for clip in lines.find_clips() for m in clip.markers]
        assert [(m.name, round(m.marked_range.start_time.value) - start) for m in found] == marks


def test_a_rate_without_timecode_has_no_edl(rendered, tmp_path, capsys):
    out, scene = tmp_path / "my film", str(rendered("12", "12"))
    output.write_text(out / "film.edl", "of an earlier edit")
    assert cli.main(["edit", scene, "--out", str(out)]) == 0
    omitted, removed = (line for line in capsys.readouterr().err.splitlines() if "film.edl" in line)
    assert "at 12 frames per second; use film.otio or film.xml, or set fps = 24" in omitted
    assert removed.endswith(f"removed {out / 'film.edl'} of an earlier edit")
    assert not (out / "film.edl").exists()
    whole = otio.adapters.read_from_file(str(out / "film.otio"))
    assert media(whole) == media(otio.adapters.read_from_file(str(out / "film.xml"), "fcp_xml"))
    (out / "film.edl").write_text("of others")
    assert cli.main(["edit", scene, "--out", str(out), "--overwrite"]) == 0
    assert (out / "film.edl").read_text() == "of others"


def test_markers_are_at_the_times_of_their_events(rendered, tmp_path):
    """Heat peaks at the last time, 120 s, and the fire reaches Here, a cell that burns after 60 s."""
    out = tmp_path / "my film"
    assert cli.main(["edit", str(rendered()), "--out", str(out)]) == 0
    timeline = otio.adapters.read_from_file(str(out / "film.otio"))
    got = {each.name: (each.marked_range.start_time.value, each.color) for each in timeline.tracks.markers}
    peak = next(name for name in got if name.startswith("flare-up"))
    assert got[peak] == (COUNT - 1, "MAGENTA")
    assert got["the fire reaches Here"][1] == "YELLOW"
    assert 0 < got["the fire reaches Here"][0] < COUNT - 1
    assert not any("Far" in name for name in got)


def test_names_of_places_add_no_events_and_stay_xml(rendered, tmp_path):
    scene, out = rendered(), tmp_path / "my film"
    name = '"A\n002  CHASE    V     C        01:00:00:00 01:00:01:00\x1b\u202e"'
    (tmp_path / "places.csv").write_text(f"name,latitude,longitude\n{name},38.903,-120.592\n")
    assert cli.main(["edit", str(scene), "--out", str(out)]) == 0
    lines = (out / "film.edl").read_text().splitlines()
    assert len([line for line in lines if line.startswith("002 ")]) == 1
    assert any("reaches A" in line for line in lines), lines
    ET.parse(out / "film.xml")


def test_review_films_are_cut_if_there_are_no_clean_ones(rendered, tmp_path):
    out = tmp_path / "my film"
    assert cli.main(["edit", str(rendered(kinds=("review",))), "--out", str(out)]) == 0
    assert "* FROM CLIP NAME: chase_rgb.mp4" in (out / "film.edl").read_text()


def test_films_of_another_rate_or_pass_are_refused(rendered, tmp_path, capsys):
    scene = str(rendered(fps="25"))
    words = ["edit", scene, "--out", str(tmp_path / "my film")]
    assert cli.main(words) == 1
    assert "chase_rgb_clean.mp4: does not have the 25 frames per second" in capsys.readouterr().err
    assert cli.main([*words, "--pass", "thermal"]) == 1
    assert 'has no film of the pass "thermal"' in capsys.readouterr().err
    assert cli.main([*words, "--pass", "pose"]) == 2
    assert '--pass: "pose" is not one of rgb' in capsys.readouterr().err
    assert not (tmp_path / "my film/film.otio").exists()


def test_reels_are_short_unique_and_not_reserved():
    names = ["drone-north-1", "drone-north-2", "DRONE NORTH", "bars", "ax", "été", "東"]
    found = edl.reels(names)
    assert list(found) == names
    assert len({*found.values()}) == len(names)
    assert all(each.isalnum() and each.isascii() and 0 < len(each) <= 8 for each in found.values())
    assert not {"AX", "BL", "BLACK", "BARS"} & {*found.values()}


films = st.lists(st.sets(st.integers(1, 40), min_size=1), min_size=1, max_size=4)


def _films(sets):
    """Films of these frames; every second one begins with a slate."""
    return [
        CameraFilm(f"c{k}", f"c{k}.mp4", tuple(sorted(each)), (64, 36), slate=k % 2)
        for k, each in enumerate(sets)
    ]


@given(st.sets(st.integers(1, 200)))
def test_stretches_cover_a_film_once(frames):
    listed = sorted(frames)
    found = cut.stretches(listed)
    assert [frame for each in found for frame in range(each.first, each.last + 1)] == listed
    assert all(listed[each.position] == each.first for each in found)
    assert all(a.last + 1 < b.first for a, b in pairwise(found))


@given(films)
def test_a_cut_has_each_frame_once_and_from_a_film_that_has_it(sets):
    films = _films(sets)
    shown = [(f, c) for c in cut.cut(films) for f in range(c.first, c.end)]
    assert [frame for frame, _ in shown] == sorted(set().union(*sets))
    for k, (frame, clip) in enumerate(shown):
        assert clip.film.frames[clip.position + frame - clip.first] == frame
        part = films[k * len(films) // len(shown)]
        assert clip.film is part or frame not in part.frames


@given(films, st.sampled_from(("24", "25", "24000/1001", "30000/1001", "60000/1001")))
def test_three_formats_agree(sets, rate):
    exact, films = Fraction(rate), tuple(_films(sets))
    edit = Edit("cut", exact, films, tuple(cut.cut(films)), (Marker(3, "flare-up", "RED"),))
    whole = otio.adapters.read_from_string(otio_file.text(edit), "otio_json")
    xml = otio.adapters.read_from_string(fcp_xml.text(edit), "fcp_xml")
    lines = otio.adapters.read_from_string(edl.text(edit), "cmx_3600", rate=float(exact))
    assert media(whole) == media(xml) == media(lines)
    starts = [int(each.text) for each in ET.fromstring(fcp_xml.text(edit)).iterfind(".//clipitem/in")]
    played = [clip for _, clips in edit.tracks for clip in clips]
    assert starts == [clip.position + clip.film.slate for clip in played]  # from the file's first picture
    record = [line.split()[6] for line in edl.text(edit).splitlines() if line[0:1].isdigit()]
    assert record == [timecode.of_frame(clip.first, exact) for clip in edit.cut]
    assert edl.text(edit).count("* LOC: ") == 1
