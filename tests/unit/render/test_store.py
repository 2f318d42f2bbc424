"""Requested and finished pictures, without Blender."""

import json
import shutil
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError, UsageError
from firetwin.render import fingerprint, manifest, plan, store
from firetwin.render.picture import Picture
from firetwin.render.store import Store
from firetwin.run import content
from firetwin.run import opening as runs
from firetwin.shot import passes, sections
from firetwin.shot import settings as s
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import code_fingerprint
from firetwin.shot.shot import Shot

CAMERAS = (
    s.Camera("drone", Drone(keys=(CameraKey(),))),
    s.Camera("satellite", Satellite(), frames="4", passes=("thermal", "rgb")),
)
SETTINGS = s.Settings(time=sections.Time(frames=4), cameras=CAMERAS)


@pytest.fixture
def shot(make_run):
    return Shot(SETTINGS, runs.open(make_run()))


def _names(pictures):
    return [(picture.camera, picture.frame, picture.name) for picture in pictures]


def test_everything_is_planned_camera_by_camera(shot):
    pictures = plan.pictures(shot)
    assert len(pictures) == 4 * 3 + 2
    assert _names(pictures)[:4] == [
        ("drone", 1, "rgb"),
        ("drone", 1, "depth"),
        ("drone", 1, "thermal"),
        ("drone", 2, "rgb"),
    ]
    assert _names(pictures)[-2:] == [("satellite", 4, "rgb"), ("satellite", 4, "thermal")]


def test_frames_cameras_and_passes_are_picked(shot):
    assert _names(plan.pictures(shot, "2,4", "drone", "thermal, rgb")) == [
        ("drone", 2, "rgb"),
        ("drone", 2, "thermal"),
        ("drone", 4, "rgb"),
        ("drone", 4, "thermal"),
    ]
    assert {picture.camera for picture in plan.pictures(shot, "1-3")} == {"drone"}
    assert _names(plan.pictures(shot, camera="satellite", names="depth")) == [("satellite", 4, "depth")]


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ({"frames": "5"}, ["--frames", "1-4"]),
        ({"frames": "3-2"}, ["--frames", "2-3"]),
        ({"frames": ""}, ["--frames", "is empty"]),
        ({"frames": "a"}, ["--frames", '"a"']),
        ({"frames": "1", "camera": "satellite"}, ["satellite", "none of these frames"]),
        ({"camera": "dron"}, ["--camera", '"dron"', "drone, satellite"]),
        ({"names": "rgb,thermla"}, ["--passes", 'did you mean "thermal"?']),
        ({"names": ""}, ["--passes"]),
    ],
)
def test_what_is_not_there_is_bad_usage(shot, choice, words):
    with pytest.raises(UsageError) as caught:
        plan.pictures(shot, **choice)
    assert all(word in str(caught.value) for word in words)


def test_a_scene_without_cameras_has_nothing_to_render(shot):
    with pytest.raises(UsageError, match=r"no \[\[cameras\]\]"):
        plan.pictures(Shot(s.Settings(), shot.run))


@pytest.fixture
def finished(tmp_path):
    """An output folder with one finished picture, its settings, and the paths of its two files."""
    picture = Picture("drone", 1, "rgb")
    made_with = {("drone", "rgb"): {"samples": 6}}
    for name in picture.files():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    with Store(tmp_path, create=True) as made:
        made.add(made_with["drone", "rgb"], {n: store.describe(tmp_path / n) for n in picture.files()})
    return tmp_path, picture, made_with


def missing(out, wanted, made_with, after=0):
    with Store(out) as made:
        return plan.missing(made, wanted, made_with, after)


def test_a_finished_shot_is_not_missing(finished):
    out, picture, made_with = finished
    assert missing(out, [picture], made_with) == []
    assert missing(out, [replace(picture, frame=2)], made_with) == [replace(picture, frame=2)]


def test_what_was_entered_before_a_number_counts_for_nothing(finished):
    out, picture, made_with = finished
    with Store(out) as made:
        number = made.latest_number()
        assert missing(out, [picture], made_with, number) == [picture]
        made.add(made_with["drone", "rgb"], {n: store.describe(out / n) for n in picture.files()})
    assert missing(out, [picture], made_with, number) == []


def test_a_copied_folder_is_finished_too(finished, tmp_path_factory):
    out, picture, made_with = finished
    copy = tmp_path_factory.mktemp("copy") / "out"
    shutil.copytree(out, copy)  # other times, other places on the disk
    assert missing(copy, [picture], made_with) == []


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("damage", ["longer", "other byte", "empty", "gone", "folder"])
def test_a_damaged_file_is_missing(finished, which, damage):
    out, picture, made_with = finished
    path = out / picture.files()[which]
    content = path.read_bytes()
    path.unlink()
    if damage == "longer":
        path.write_bytes(content + b"x")
    elif damage == "other byte":
        path.write_bytes(b"x" + content[1:])
    elif damage == "empty":
        path.write_bytes(b"")
    elif damage == "folder":
        path.mkdir()
    assert missing(out, [picture], made_with) == [picture]


def test_other_settings_make_a_picture_missing(finished):
    out, picture, _ = finished
    assert missing(out, [picture], {("drone", "rgb"): {"samples": 7}}) == [picture]


def test_a_file_that_nothing_names_is_missing(finished):
    out, picture, made_with = finished
    (out / store.NAME).unlink()
    assert missing(out, [picture], made_with) == [picture]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 2}', "\x00\x01"])
def test_what_is_not_a_manifest_is_not_overwritten(tmp_path, text):
    (tmp_path / manifest.NAME).write_text(text)
    with pytest.raises(InputError, match="not a manifest"):
        Store(tmp_path)
    with pytest.raises(InputError, match="not a manifest"):
        Store(tmp_path, create=True)
    assert (tmp_path / manifest.NAME).read_text() == text


def test_what_is_not_a_store_is_not_overwritten(tmp_path):
    other = sqlite3.connect(tmp_path / store.NAME)
    other.execute("CREATE TABLE mine (a)")
    other.close()
    with pytest.raises(InputError, match="not a store"):
        Store(tmp_path, create=True)
    (tmp_path / store.NAME).write_text("somebody's own words, long enough for a header" * 9)
    with pytest.raises(InputError, match="not a store"):
        Store(tmp_path)
    assert "somebody" in (tmp_path / store.NAME).read_text()


def test_nothing_is_made_to_look(tmp_path):
    with Store(tmp_path / "out") as made:
        assert made.names() == []
    assert not (tmp_path / "out").exists()


def test_processes_that_render_into_one_folder_lose_no_entries(tmp_path):
    code = """
import pathlib, sys
from firetwin.render.store import Store
for i in range(20):
    with Store(pathlib.Path(sys.argv[1]), create=True) as store:
        store.add({"by": sys.argv[2]}, {sys.argv[2] + str(i): {}})
store.__init__(pathlib.Path(sys.argv[1]))
store.export()
"""
    command = [sys.executable, "-c", code, str(tmp_path)]
    running = [subprocess.Popen([*command, name]) for name in "abc"]
    assert [process.wait() for process in running] == [0, 0, 0]
    files = json.loads((tmp_path / manifest.NAME).read_text())["files"]
    assert len(files) == 60
    assert {path.name for path in tmp_path.iterdir()} == {store.NAME, manifest.NAME}


def test_the_manifest_is_written_when_there_is_something_new(finished):
    out, picture, made_with = finished
    with Store(out) as opened:
        opened.export()
        told = json.loads((out / manifest.NAME).read_text())
        key = content.fingerprint(made_with["drone", "rgb"])
        assert told["settings"] == {key: made_with["drone", "rgb"]}
        assert set(told["files"]) == set(picture.files())
        first = picture.files()[0]
        assert told["files"][first] == store.describe(out / first) | {"settings": key}
        before = (out / manifest.NAME).stat()
        opened.export()
        assert (out / manifest.NAME).stat().st_ino == before.st_ino
        opened.add({"samples": 7}, {picture.files()[0]: {"bytes": 0}})
        opened.export()
        assert len(json.loads((out / manifest.NAME).read_text())["settings"]) == 2


def showing(aspect):
    """Passes that show an aspect, themselves or by the passes that they are made from."""
    return {name for name, each in passes.known().items() if aspect in each.all_aspects}


def test_a_picture_depends_on_the_settings_that_it_shows():
    def key(changed, name, run="0"):
        made = fingerprint.collect_inputs(changed, {"heat_flux.npy": run}, "drone", name)
        return content.fingerprint(made)

    def changes(**parts):
        changed = replace(SETTINGS, **parts)
        return {name for name in passes.known() if key(changed, name) != key(SETTINGS, name)}

    everything = set(passes.known())
    filmed, lit, smoky = (showing(aspect) for aspect in ("film", "light", "smoke"))
    assert changes() == set()
    assert changes(seed=2) == everything
    assert changes(time=replace(SETTINGS.time, frames=5)) == everything
    assert changes(time=replace(SETTINGS.time, fps=5, zone="UTC")) == filmed >= {"fused", "split"}
    assert changes(terrain=sections.TerrainSettings(apron=1.0)) == everything
    assert changes(render=s.Render(resolution=(64, 36))) == everything
    assert changes(render=s.Render(samples=7)) == showing("grain") == lit >= {"rgb", "thermal", "edl"}
    assert changes(light=sections.Light(haze=0.5)) == lit
    assert changes(smoke=sections.SmokeSettings(cloud_base=9.0)) == smoky >= lit | {"masks", "nerfstudio"}
    assert changes(render=s.Render(thermal_high=900.0)) == showing("thermal") >= {"overlay", "data"}
    assert changes(render=s.Render(passes=("rgb",), video=False, device="cpu")) == {"pose"}
    # Built objects and their detail depend on the filmed frames.
    assert changes(cameras=(replace(CAMERAS[0], frames="1"), CAMERAS[1])) == everything
    assert changes(cameras=(CAMERAS[0], replace(CAMERAS[1], frames="1"))) == set()
    assert key(SETTINGS, "rgb", "1") != key(SETTINGS, "rgb")


@pytest.mark.parametrize(
    ("listed", "chunk", "same"), [("", 0, True), ("", 9, True), ("", 2, False), ("1-2", 2, True)]
)
def test_a_longer_chunk_spoils_nothing_that_is_built_at_once(listed, chunk, same):
    """The frames of a chunk determine the picture, not the number of other frames."""

    def key(chunk):
        changed = replace(
            SETTINGS,
            time=replace(SETTINGS.time, frames=4),
            cameras=(replace(CAMERAS[0], frames=listed), CAMERAS[1]),
            render=s.Render(chunk=chunk),
        )
        return fingerprint.collect_inputs(changed, {}, "drone", "rgb")

    assert (key(chunk) == key(480)) is same


def test_a_picture_depends_on_its_own_camera_and_no_other():
    def keys(cameras):
        changed = replace(SETTINGS, cameras=cameras)
        return [fingerprint.collect_inputs(changed, {}, name, "rgb") for name in ("drone", "satellite")]

    moved = replace(CAMERAS[1], rig=Satellite(swath=9.0))
    before, after = keys(CAMERAS), keys((CAMERAS[0], moved))
    assert before[0] == after[0]
    assert before[1] != after[1]


def test_input_hashes_follow_every_field(make_run, tmp_path):
    folder = make_run("text")
    run = runs.open(folder)
    before = content.inputs(run, tmp_path / "cache")
    assert {"run.toml", "heat_flux", "elevation.txt"} <= set(before)
    assert "wind_east" in before
    assert "wind_east" not in content.inputs(run, tmp_path / "cache", leave_out=("wind_east",))
    one = folder / "heat_flux" / "000001.txt"
    one.write_text(one.read_text().replace("1000.5", "1000.6"))
    after = content.inputs(run, tmp_path / "cache")
    assert {name for name in before if before[name] != after[name]} == {"heat_flux"}


def test_what_else_lies_in_the_run_folder_changes_nothing(make_run):
    folder = make_run()
    run = runs.open(folder)
    before = content.inputs(run, folder / "cache")
    (folder / "cache" / "0123456789abcdef").mkdir(parents=True)
    (folder / "cache" / "0123456789abcdef" / "smoke_000001.vdb").write_bytes(b"smoke")
    (folder / "film").mkdir()
    (folder / "film" / "elevation.npy").write_bytes(b"x")
    (folder / "notes.md").write_text("mine")
    assert content.inputs(run, folder / "cache") == before


def _aged(folder):
    """Wait until files count as old enough to be remembered."""
    youngest = max(path.stat().st_ctime for path in folder.rglob("*"))
    time.sleep(max(0.0, youngest + content._YOUNG + 0.05 - time.time()))


def test_hashes_are_remembered(make_run, tmp_path, monkeypatch):
    folder, read = make_run(), []
    run, original = runs.open(folder), content.sha256
    monkeypatch.setattr(content, "sha256", lambda path, step: read.append(path.name) or original(path, step))
    _aged(folder)

    def again():
        content._read.clear()  # as in another process
        read.clear()
        return content.inputs(run, tmp_path / "cache")

    first = again()
    assert len(read) == len(first)
    assert again() == first
    assert read == []
    (folder / content.REMEMBERED).write_text('{"elevation.npy": [1, {}')
    assert again() == first
    assert len(read) == len(first)
    flux = np.load(folder / "heat_flux.npy")
    np.save(folder / "heat_flux.npy", 2 * flux)
    assert again() != first
    assert read == ["heat_flux.npy"]
    again()
    assert read == ["heat_flux.npy"]  # too young to be remembered


def test_a_run_that_cannot_be_written_is_remembered_in_the_cache(make_run, tmp_path, monkeypatch):
    folder = make_run()
    run = runs.open(folder)
    _aged(folder)
    write = Path.write_text

    def refuse(path, *arguments, **options):
        if path.parent == folder:
            raise PermissionError(13, "Permission denied")
        return write(path, *arguments, **options)

    monkeypatch.setattr(Path, "write_text", refuse)
    content._read.clear()
    first = content.inputs(run, tmp_path / "cache")
    assert [path.name[:4] for path in (tmp_path / "cache").iterdir()] == ["run-"]
    assert not (folder / content.REMEMBERED).exists()
    content._read.clear()
    monkeypatch.setattr(content, "sha256", None)
    assert content.inputs(run, tmp_path / "cache") == first


def test_the_first_reading_of_a_large_run_shows_how_far_it_is(make_run, tmp_path):
    folder, told = make_run(), []
    run = runs.open(folder)
    with (folder / "temperature.npy").open("ab") as file:
        file.truncate(20_000_000)
    content._read.clear()
    content.inputs(run, tmp_path, progress=lambda *how: told.append(how))
    assert told[-1][:2] == (20, 20)
    assert told[-1][2].startswith("reading the run")


def made_from(name):
    """Passes that a pass is made from, directly or not."""
    needs = passes.known()[name].made_from
    return {*needs, *(other for need in needs for other in made_from(need))}


def test_a_changed_source_changes_what_it_makes_and_no_more(tmp_path, monkeypatch):
    shutil.copytree(
        code_fingerprint.PACKAGE, tmp_path / "addon", ignore=shutil.ignore_patterns("__pycache__")
    )
    monkeypatch.setattr(code_fingerprint, "PACKAGE", tmp_path / "addon")

    def keys():
        code_fingerprint._hash.cache_clear()
        made = {n: fingerprint.collect_inputs(SETTINGS, {}, "drone", n) for n in passes.known()}
        return {name: content.fingerprint(each) for name, each in made.items()}

    def changed(name):
        before, path = keys(), tmp_path / "addon" / name
        path.write_text(path.read_text() + "# more\n")
        after = keys()
        return {name for name in before if before[name] != after[name]}

    assert changed("scene/smoke/material.py") == showing("smoke")
    assert changed("scene/fire/flames.py") == showing("fire")
    assert changed("passes/depth.py") == {n for n in passes.known() if "depth" in (n, *made_from(n))}
    assert {"rgb", "thermal", "masks", "depth"} <= changed("scene/stations/signs.py")
    assert {"rgb", "thermal", "masks", "depth"} <= changed("stations/reading.py")
    finished = {n for n in passes.known() if any(passes.known()[k].finished for k in (n, *made_from(n)))}
    assert changed("imaging/colour_bar.py") == finished >= {"depth", "split"}
    assert changed("scene/terrain/build.py") == set(passes.known())
    assert changed("scene/haze.py") == set(passes.known())
    assert changed("shot/fire/fire.py") == set(passes.known())
    assert changed("render/engine.py") == set(passes.known())
    assert changed("ui/render.py") == changed("bench/text.py") == changed("render/store.py") == set()
    before = keys()
    path = tmp_path / "addon" / "smoke/bake.py"
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert keys() == before
    code_fingerprint._hash.cache_clear()
