"""Exports as processes: killed, on a full disk, and opened by QGIS."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from scene_text import BARE, DRONE, NO_SMOKE, THREE_FRAMES

QGIS = Path(__file__).parent / "open_in_qgis.py"
FORMATS = ("kmz", "czml", "gis")


@pytest.fixture
def scene(run_folder, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text((THREE_FRAMES + NO_SMOKE + BARE + DRONE).format(run=run_folder))
    return path


def command(scene, name, out):
    return [sys.executable, "-m", "firetwin", "export", scene, "--to", name, "--out", out]


def content(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_killed_export_leaves_the_folder_as_it_was(scene, tmp_path):
    out = tmp_path / "out"
    subprocess.run(command(scene, "gis", out), check=True, capture_output=True)
    before = content(out)
    scene.write_text(scene.read_text().replace("frames = 3", "frames = 2"))
    running = subprocess.Popen(
        command(scene, "gis", out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    while not list(tmp_path.glob(".out.*.part/*")) and running.poll() is None:
        time.sleep(0.005)
    running.send_signal(signal.SIGKILL)
    assert running.wait() == -signal.SIGKILL
    assert content(out) == before
    subprocess.run(command(scene, "gis", out), check=True, capture_output=True)
    assert content(out) != before


@pytest.mark.parametrize("name", FORMATS)
def test_a_full_disk_is_one_line_and_leaves_nothing(name, scene, tmp_path):
    place = tmp_path / "small"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", place]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("a small disk cannot be mounted here")
    try:
        ended = subprocess.run(command(scene, name, place / "out"), capture_output=True, text=True)
        assert ended.returncode == 1
        assert "the disk is full" in ended.stderr.splitlines()[-1]
        assert "Traceback" not in ended.stderr
        assert list(place.iterdir()) == []
    finally:
        subprocess.run(["umount", place], check=True)


def test_qgis_opens_the_project_and_all_layers(scene, tmp_path):
    python = shutil.which("python3", path="/usr/bin") or ""
    if not python or subprocess.run([python, "-c", "import qgis.core"], capture_output=True).returncode:
        pytest.skip("needs QGIS with its Python modules")
    out = tmp_path / "my map"
    subprocess.run(command(scene, "gis", out), check=True, capture_output=True)
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    ended = subprocess.run(
        [python, QGIS, out / "firetwin.qgs"],
        capture_output=True,
        text=True,
        env=environment | {"QT_QPA_PLATFORM": "offscreen"},
    )
    lines = ended.stdout.splitlines()
    assert lines[0].startswith("project EPSG:326"), ended.stderr
    layers = dict(line.rsplit(maxsplit=1) for line in lines[1:])
    assert {"firetwin_fronts", "firetwin_camera_frames", "firetwin_arrival"} <= {*layers}
    assert {*layers.values()} <= {"valid", "dated"}
    assert layers["firetwin_fronts"] == "dated"
