"""`firetwin render` as a process: its files, the effect of --resume, and the remains of a kill."""

import json
import os
import signal
import subprocess
import sys
import time

import child_work
import pytest
from firetwin import progress
from firetwin.errors import Error
from firetwin.jobs import worker
from firetwin.render.store import Store
from firetwin.shot import passes
from firetwin_core import sensor
from scene_text import DRONE, NO_PLANTS, NO_SMOKE, TINY

FRAMES = 3
SCENE = (
    """\
run = "{run}"
[time]
frames = {frames}
"""
    + NO_PLANTS
    + NO_SMOKE
    + TINY
    + """\
{render}
"""
    + DRONE
    + """\
[[cameras]]
name = "satellite"
kind = "satellite"
swath = 8000.0
frames = "2"
passes = ["depth"]
"""
)


@pytest.fixture(scope="module")
def command(run_folder, tmp_path_factory):
    """Start `firetwin` on a scene file with other [render] lines: command(arguments) -> process."""
    folder = tmp_path_factory.mktemp("render")

    def start(*arguments, render="", verb="render", frames=FRAMES, size=""):
        scene = folder / "scene.toml"
        text = SCENE.format(run=run_folder, frames=frames, render=render)
        scene.write_text(text.replace("resolution = [64, 36]\n", size) if size else text)
        return subprocess.Popen(
            [sys.executable, "-m", "firetwin", verb, scene, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            # Background jobs of shells ignore Ctrl-C and hand that on; a person's command does not.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    return start


@pytest.fixture(scope="module")
def firetwin(command):
    """Run it to its end: (stdout, stderr)."""

    def run(*arguments, status=0, **options):
        process = command(*arguments, **options)
        out, err = process.communicate(timeout=900)
        assert process.returncode == status, err
        return out, err

    return run


@pytest.fixture(scope="module")
def film(firetwin, tmp_path_factory):
    """Everything rendered once."""
    out = tmp_path_factory.mktemp("film")
    return out, firetwin("--out", out)


def _state(out):
    """Name -> (time of change, inode) of every file."""
    return {
        str(path.relative_to(out)): (path.stat().st_mtime_ns, path.stat().st_ino)
        for path in out.rglob("*")
        if path.is_file() and not path.name.startswith("store.sqlite")
    }


def _changed(before, out):
    after = _state(out)
    return {name for name in after if after[name] != before.get(name)}


def _files(camera, name, frames, *suffixes):
    return {f"{camera}/{name}/{camera}_{name}_{frame:06d}.{s}" for frame in frames for s in suffixes}


EVERYTHING = (
    _files("drone", "rgb", (1, 2, 3), "png", "exr")
    | _files("drone", "depth", (1, 2, 3), "exr")
    | _files("drone", "thermal", (1, 2, 3), "png", "exr")
    | _files("satellite", "depth", (2,), "exr")
    | {"drone/drone_rgb.mp4", "drone/drone_thermal.mp4", "manifest.json"}
)


def test_all_files_are_made_named_and_listed(film):
    out, (listed, said) = film
    assert set(_state(out)) == EVERYTHING
    assert f"{out}/drone/rgb/*.png  3 pictures" in listed
    assert f"{out}/drone/drone_rgb.mp4" in listed
    assert all(line.startswith("firetwin: ") for line in said.splitlines())


@pytest.mark.parametrize("resolution", [(64, 36), (1280, 720)])
def test_memory_is_expected_before_and_measured_after(firetwin, tmp_path, resolution):
    """Within a factor of 1.5 of each other, of a small picture and of one of 400 times the pixels."""
    size = f"resolution = [{resolution[0]}, {resolution[1]}]\n"
    asked = ("--out", tmp_path, "--camera", "drone", "--frames", "1", "--json")
    printed, said = firetwin(*asked, size=size)
    summary = json.loads(printed)
    assert (summary["pictures"], summary["folder"]) == (3, str(tmp_path))
    assert set(summary["files"]) == _files("drone", "rgb", (1,), "png", "exr") | _files(
        "drone", "thermal", (1,), "png", "exr"
    ) | _files("drone", "depth", (1,), "exr")
    memory = summary["memory"]
    assert 1 / 1.5 < memory["expected"] / memory["peak"] < 1.5, memory
    words = f"firetwin: rendering takes about {progress.size(memory['expected'])} of memory at most"
    assert said.splitlines().count(words) == 1
    again, _ = firetwin(*asked, "--resume", size=size)
    assert json.loads(again) == summary | {"pictures": 0, "memory": {"expected": None, "peak": None}}


def test_the_manifest_tells_what_made_each_file(film):
    out, _ = film
    manifest = json.loads((out / "manifest.json").read_text())
    assert set(manifest["files"]) == EVERYTHING - {"manifest.json"}
    entry = manifest["files"]["drone/rgb/drone_rgb_000002.png"]
    assert (entry["camera"], entry["pass"], entry["frame"]) == ("drone", "rgb", 2)
    assert entry["time"] == "2014-09-17T21:30:00+00:00"
    settings = manifest["settings"][entry["settings"]]
    assert settings["settings"]["render"]["samples"] == 1
    assert set(settings["versions"]) == {"firetwin", "blender"}
    assert {"core", "scene", "scene/smoke", "passes/rgb.py"} <= set(settings["sources"])
    assert len(settings["run"]["heat_flux.npy"]) == 64


def test_resume_renders_what_is_damaged_and_no_more(film, firetwin):
    out, _ = film
    before = _state(out)
    listed, said = firetwin("--out", out, "--resume")
    assert _state(out) == before
    assert "nothing to render" in said
    assert "drone_rgb.mp4" in listed
    broken = out / "drone/thermal/drone_thermal_000002.exr"
    content = bytearray(broken.read_bytes())
    content[len(content) // 2] ^= 1
    broken.write_bytes(content)
    (out / "satellite/depth/satellite_depth_000002.exr").unlink()
    before = _state(out)
    _, said = firetwin("--out", out, "--resume")
    assert "8 of 10 pictures are finished" in said
    changed = _files("drone", "thermal", (2,), "png", "exr") | _files("satellite", "depth", (2,), "exr")
    assert _changed(before, out) - {"drone/drone_thermal.mp4"} == changed | {"manifest.json"}


def test_without_resume_everything_asked_for_is_rendered_again(film, firetwin):
    out, _ = film
    firetwin("--out", out, "--resume")
    before = _state(out)
    _, said = firetwin("--out", out, "--frames", "3", "--passes", "depth", "--camera", "drone")
    assert "1 picture again" in said
    assert "--resume" in said
    assert _changed(before, out) == _files("drone", "depth", (3,), "exr") | {"manifest.json"}


def test_a_killed_render_leaves_nothing_that_resume_accepts_wrongly(command, firetwin, tmp_path):
    out = tmp_path / "out"
    process = command("--out", out, render="seed = 1")
    while not any(out.glob("drone/*/*_000001.*")) and process.poll() is None:
        time.sleep(0.002)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    with Store(out) as store:
        finished = set(store.names())
    assert len(finished) < len(EVERYTHING) - 1
    before = _state(out)
    firetwin("--out", out, "--resume", render="seed = 1")
    assert set(_state(out)) == EVERYTHING
    assert not finished & _changed(before, out)


def test_ctrl_c_stops_cleanly(command, tmp_path):
    out = tmp_path / "out"
    process = command("--out", out, render="seed = 2", frames=500)  # minutes, were it not stopped
    for line in process.stderr:
        if "rendering: 0 of" in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    out_text, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert err.splitlines()[-1] == "firetwin: stopped; finished files stay"
    assert "Traceback" not in err
    assert out_text == ""
    assert not list(out.glob(".part-*"))


def test_a_gpu_that_is_not_there_is_one_line_before_anything_is_built(firetwin, tmp_path):
    out, err = firetwin("--out", tmp_path / "out", render='device = "gpu"', status=1)
    assert out == ""
    assert "building" not in err
    last = err.splitlines()[-1]
    assert 'scene.toml:16:1: device = "gpu", but Cycles finds no GPU' in last
    assert "log of Blender" not in last


def test_a_fused_view_of_small_pictures_is_large_enough_to_read_and_so_is_its_film(firetwin, tmp_path):
    firetwin("--out", tmp_path, "--camera", "drone", "--passes", "fused", "--frames", "1-2")
    sheet = sensor.read_image(tmp_path / "drone/fused/drone_fused_000001.png")
    assert sheet.shape[0] == 720
    probe = ["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of", "csv=p=0"]
    film = subprocess.run([*probe, tmp_path / "drone/drone_fused.mp4"], check=True, capture_output=True)
    assert film.stdout.decode().strip() == f"{sheet.shape[1]},720"


def test_the_blend_file_is_complete_and_needs_no_add_on(firetwin, tmp_path):
    import bpy

    path = tmp_path / "scene.blend"
    listed, _ = firetwin("-o", path, verb="build")
    assert listed == f"{path}\n"
    assert [left.name for left in tmp_path.glob("[!.]*")] == ["scene.blend"]
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    rendered = {name for name, each in passes.known().items() if isinstance(each, passes.RenderedPass)}
    assert {layer.name for layer in scene.view_layers} == rendered
    assert (scene.render.resolution_x, scene.render.resolution_y) == (64, 36)
    assert scene.cycles.samples == 1
    assert (scene.frame_start, scene.frame_end) == (1, FRAMES)
    assert not bpy.data.texts


def test_a_crash_of_blender_is_one_clear_line(monkeypatch):
    child_work.importable(monkeypatch)
    with pytest.raises(Error, match=r"stopped on signal 6 \(SIGABRT\).* log of Blender is") as caught:
        worker.run(child_work.abort, eevee=True)
    assert "EEVEE needs OpenGL" in str(caught.value)
