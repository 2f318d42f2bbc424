"""Which shots are asked for, and which count as finished. Without Blender."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import pytest
from firetwin import project
from firetwin.errors import InputError, UsageError
from firetwin.render import manifest, part, passes, plan, settings
from firetwin.render.passes import Shot

CAMERAS = (
    project.Camera("drone", keys=(project.CameraKey(),)),
    project.Camera("satellite", kind="satellite", frames="4", passes=("thermal", "rgb")),
)
PROJECT = project.Project(time=project.Time(frames=4), cameras=CAMERAS)


def _names(shots):
    return [(shot.camera, shot.frame, shot.name) for shot in shots]


def test_everything_is_planned_camera_by_camera():
    shots = plan.shots(PROJECT)
    assert len(shots) == 4 * 3 + 2
    assert _names(shots)[:4] == [
        ("drone", 1, "rgb"),
        ("drone", 1, "depth"),
        ("drone", 1, "thermal"),
        ("drone", 2, "rgb"),
    ]
    assert _names(shots)[-2:] == [("satellite", 4, "rgb"), ("satellite", 4, "thermal")]


def test_frames_cameras_and_passes_are_picked():
    assert _names(plan.shots(PROJECT, "2,4", "drone", "thermal, rgb")) == [
        ("drone", 2, "rgb"),
        ("drone", 2, "thermal"),
        ("drone", 4, "rgb"),
        ("drone", 4, "thermal"),
    ]
    assert {shot.camera for shot in plan.shots(PROJECT, "1-3")} == {"drone"}
    assert _names(plan.shots(PROJECT, camera="satellite", names="depth")) == [("satellite", 4, "depth")]


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ({"frames": "5"}, ["--frames", "1-4"]),
        ({"frames": "a"}, ["--frames", '"a"']),
        ({"frames": "1", "camera": "satellite"}, ["satellite", "none of these frames"]),
        ({"camera": "dron"}, ["--camera", '"dron"', "drone, satellite"]),
        ({"names": "rgb,thermla"}, ["--passes", "did you mean thermal?"]),
        ({"names": ""}, ["--passes"]),
    ],
)
def test_what_is_not_there_is_bad_usage(choice, words):
    with pytest.raises(UsageError) as caught:
        plan.shots(PROJECT, **choice)
    assert all(word in str(caught.value) for word in words)


def test_a_scene_without_cameras_has_nothing_to_render():
    with pytest.raises(UsageError, match=r"no \[\[cameras\]\]"):
        plan.shots(project.Project())


@pytest.fixture
def finished(tmp_path):
    """An output folder with one finished shot, its settings, and the paths of its two files."""
    shot = Shot("drone", 1, "rgb")
    made_with = {("drone", "rgb"): {"samples": 6}}
    for name in shot.files():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    manifest.add(
        tmp_path, made_with["drone", "rgb"], {n: manifest.describe(tmp_path / n) for n in shot.files()}
    )
    return tmp_path, shot, made_with


def test_a_finished_shot_is_not_missing(finished):
    out, shot, made_with = finished
    assert plan.missing(out, [shot], made_with) == []
    assert plan.missing(out, [replace(shot, frame=2)], made_with) == [replace(shot, frame=2)]


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("damage", ["longer", "other byte", "empty", "gone", "folder"])
def test_a_damaged_file_is_missing(finished, which, damage):
    out, shot, made_with = finished
    path = out / shot.files()[which]
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
    assert plan.missing(out, [shot], made_with) == [shot]


def test_other_settings_make_a_shot_missing(finished):
    out, shot, _ = finished
    assert plan.missing(out, [shot], {("drone", "rgb"): {"samples": 7}}) == [shot]


def test_a_file_that_no_manifest_names_is_missing(finished):
    out, shot, made_with = finished
    (out / manifest.NAME).unlink()
    assert plan.missing(out, [shot], made_with) == [shot]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 2}', "\x00\x01"])
def test_what_is_not_a_manifest_is_not_overwritten(tmp_path, text):
    (tmp_path / manifest.NAME).write_text(text)
    with pytest.raises(InputError, match="not a manifest"):
        manifest.load(tmp_path)
    with pytest.raises(InputError, match="not a manifest"):
        manifest.add(tmp_path, {}, {"a": {}})
    assert (tmp_path / manifest.NAME).read_text() == text


def test_processes_that_render_into_one_folder_lose_no_entries(tmp_path):
    code = """
import pathlib, sys
from firetwin.render import manifest
for i in range(20):
    manifest.add(pathlib.Path(sys.argv[1]), {"by": sys.argv[2]}, {sys.argv[2] + str(i): {}})
"""
    command = [sys.executable, "-c", code, str(tmp_path)]
    running = [subprocess.Popen([*command, name]) for name in "abc"]
    assert [process.wait() for process in running] == [0, 0, 0]
    files = json.loads((tmp_path / manifest.NAME).read_text())["files"]
    assert len(files) == 60
    assert {path.name for path in tmp_path.iterdir()} == {manifest.NAME, ".lock"}


def test_settings_of_a_pass_are_those_that_it_depends_on():
    def key(changed, name):
        return manifest.fingerprint(settings.of_shot(changed, {"heat_flux.npy": "0"}, "drone", name))

    def changes(**parts):
        changed = replace(PROJECT, **parts)
        return {name for name in passes.ALL if key(changed, name) != key(PROJECT, name)}

    everything = {"rgb", "depth", "thermal"}
    assert changes() == set()
    assert changes(seed=2) == everything
    assert changes(time=replace(PROJECT.time, frames=5)) == everything
    assert changes(time=replace(PROJECT.time, fps=5, zone="UTC")) == set()
    assert changes(terrain=project.Terrain(apron=1.0)) == everything
    assert changes(render=project.Render(resolution=(64, 36))) == everything
    assert changes(render=project.Render(samples=7)) == {"rgb", "thermal"}
    assert changes(light=project.Light(haze=0.5)) == {"rgb", "thermal"}
    assert changes(render=project.Render(thermal_high=900.0)) == {"thermal"}
    assert changes(render=project.Render(passes=("rgb",), video=False)) == set()
    assert changes(cameras=(replace(CAMERAS[0], frames="1"), CAMERAS[1])) == set()
    assert changes(cameras=(CAMERAS[0], replace(CAMERAS[1], swath=9.0))) == everything
    assert key(PROJECT, "rgb") != manifest.fingerprint(settings.of_shot(PROJECT, {}, "drone", "rgb"))


def test_input_hashes_follow_every_file(make_run):
    folder = make_run("text")
    before = settings.inputs(folder)
    assert {"run.toml", "heat_flux", "elevation.txt"} <= set(before)
    (folder / ".hidden").write_text("x")
    assert settings.inputs(folder) == before
    one = folder / "heat_flux" / "000001.txt"
    one.write_text(one.read_text().replace("1000.5", "1000.6"))
    after = settings.inputs(folder)
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
