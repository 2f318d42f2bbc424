"""Which pictures are asked for, and which count as finished. Without Blender."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import pytest
from firetwin.errors import InputError, UsageError
from firetwin.render import fingerprint, part, plan, store
from firetwin.render.picture import Picture
from firetwin.run import content
from firetwin.shot import passes
from firetwin.shot import settings as s
from firetwin.shot.rigs._key import CameraKey
from firetwin.shot.rigs.drone import Drone
from firetwin.shot.rigs.satellite import Satellite
from firetwin.shot.shot import Shot
from firetwin_core import run as runs

CAMERAS = (
    s.Camera("drone", Drone(keys=(CameraKey(),))),
    s.Camera("satellite", Satellite(), frames="4", passes=("thermal", "rgb")),
)
SETTINGS = s.Settings(time=s.Time(frames=4), cameras=CAMERAS)


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
    store.add(tmp_path, made_with["drone", "rgb"], {n: store.describe(tmp_path / n) for n in picture.files()})
    return tmp_path, picture, made_with


def test_a_finished_shot_is_not_missing(finished):
    out, picture, made_with = finished
    assert plan.missing(out, [picture], made_with) == []
    assert plan.missing(out, [replace(picture, frame=2)], made_with) == [replace(picture, frame=2)]


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
    assert plan.missing(out, [picture], made_with) == [picture]


def test_other_settings_make_a_picture_missing(finished):
    out, picture, _ = finished
    assert plan.missing(out, [picture], {("drone", "rgb"): {"samples": 7}}) == [picture]


def test_a_file_that_nothing_names_is_missing(finished):
    out, picture, made_with = finished
    (out / store.NAME).unlink()
    assert plan.missing(out, [picture], made_with) == [picture]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 2}', "\x00\x01"])
def test_what_is_not_a_manifest_is_not_overwritten(tmp_path, text):
    (tmp_path / store.NAME).write_text(text)
    with pytest.raises(InputError, match="not a manifest"):
        store.load(tmp_path)
    with pytest.raises(InputError, match="not a manifest"):
        store.add(tmp_path, {}, {"a": {}})
    assert (tmp_path / store.NAME).read_text() == text


def test_processes_that_render_into_one_folder_lose_no_entries(tmp_path):
    code = """
import pathlib, sys
from firetwin.render import store
for i in range(20):
    store.add(pathlib.Path(sys.argv[1]), {"by": sys.argv[2]}, {sys.argv[2] + str(i): {}})
"""
    command = [sys.executable, "-c", code, str(tmp_path)]
    running = [subprocess.Popen([*command, name]) for name in "abc"]
    assert [process.wait() for process in running] == [0, 0, 0]
    files = json.loads((tmp_path / store.NAME).read_text())["files"]
    assert len(files) == 60
    assert {path.name for path in tmp_path.iterdir()} == {store.NAME, ".lock"}


def test_a_picture_depends_on_the_settings_that_it_shows():
    def key(changed, name, run="0"):
        made = fingerprint.of_picture(changed, {"heat_flux.npy": run}, "drone", name)
        return content.fingerprint(made)

    def changes(**parts):
        changed = replace(SETTINGS, **parts)
        return {name for name in passes.known() if key(changed, name) != key(SETTINGS, name)}

    everything = set(passes.known())
    lit = {"rgb", "thermal"}
    assert changes() == set()
    assert changes(seed=2) == everything
    assert changes(time=replace(SETTINGS.time, frames=5)) == everything
    assert changes(time=replace(SETTINGS.time, fps=5, zone="UTC")) == set()
    assert changes(ground=s.Ground(apron=1.0)) == everything
    assert changes(render=s.Render(resolution=(64, 36))) == everything
    assert changes(render=s.Render(samples=7)) == lit
    assert changes(light=s.Light(haze=0.5)) == lit
    assert changes(smoke=s.Smoke(max_age=9.0)) == lit
    assert changes(render=s.Render(thermal_high=900.0)) == {"thermal"}
    assert changes(render=s.Render(passes=("rgb",), video=False, device="cpu")) == set()
    assert changes(cameras=(replace(CAMERAS[0], frames="1"), CAMERAS[1])) == set()
    assert key(SETTINGS, "rgb", "1") != key(SETTINGS, "rgb")


def test_a_picture_depends_on_its_own_camera_and_no_other():
    def keys(cameras):
        changed = replace(SETTINGS, cameras=cameras)
        return [fingerprint.of_picture(changed, {}, name, "rgb") for name in ("drone", "satellite")]

    moved = replace(CAMERAS[1], rig=Satellite(swath=9.0))
    before, after = keys(CAMERAS), keys((CAMERAS[0], moved))
    assert before[0] == after[0]
    assert before[1] != after[1]


def test_input_hashes_follow_every_file(make_run):
    folder = make_run("text")
    before = content.inputs(folder)
    assert {"run.toml", "heat_flux", "elevation.txt"} <= set(before)
    (folder / ".hidden").write_text("x")
    assert content.inputs(folder) == before
    one = folder / "heat_flux" / "000001.txt"
    one.write_text(one.read_text().replace("1000.5", "1000.6"))
    after = content.inputs(folder)
    assert {name for name in before if before[name] != after[name]} == {"heat_flux"}


def test_files_in_the_making_are_cleared_away(tmp_path):
    dead = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, text=True
    )
    left = tmp_path / f".part-{dead.stdout.strip()}"
    left.mkdir()
    alive = tmp_path / f".part-{os.getppid()}"
    alive.mkdir()
    with part.part_folder(tmp_path) as folder:
        assert folder.is_dir()
        (folder / "x").write_text("x")
    assert [path for path in (left, folder, alive) if path.exists()] == [alive]
