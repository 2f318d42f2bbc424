"""The script for OpenCue, run by pyoutline as far as it goes without a server: to the job's specification."""

import os
import shlex
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from small_job import batch, write

PLACE = Path(__file__).parents[3] / "build" / "opencue"
PACKAGES = ("opencue-pyoutline==1.37.0", "packaging")  # which it imports and does not name
READ = "import launch, sys; print(launch.build(sys.argv[1:]).serialize(use_pycuerun=False))"


@pytest.fixture(scope="module")
def specification():
    """pyoutline in a separate environment: specification(folder, options...) -> specification of a job."""
    python = PLACE / "bin" / "python"
    if not python.exists():
        for each in (
            [sys.executable, "-m", "venv", PLACE],
            [python, "-m", "pip", "install", "-q", *PACKAGES],
        ):
            done = subprocess.run(each, capture_output=True, text=True)
            if done.returncode:
                pytest.skip(f"pyoutline cannot be installed here: {done.stderr.strip()[-300:]}")

    def run(folder, *options):
        home = os.environ | {"HOME": str(folder / "home")}  # where pyoutline keeps a copy of each job
        done = subprocess.run(
            [python, "-c", READ, *options], cwd=folder, env=home, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return ElementTree.fromstring(done.stdout)

    return run


def test_layers_are_the_stages_and_frames_the_tasks(specification, tmp_path):
    whole = batch(tmp_path)
    spec = specification(write("opencue", whole)[0], "show=fire", "cores=4", "memory=8g", "gpus=1")
    layers = {each.get("name"): each for each in spec.iter("layer")}
    ranges = {name: layer.findtext("range") for name, layer in layers.items()}
    assert ranges == {"bake": "1-2", "render": "3-7", "assemble": "1-1"}
    farm = [sys.executable, "-m", "firetwin", "farm"]
    for name, layer in layers.items():
        last = ["assemble", str(whole.out)] if name == "assemble" else ["task", str(whole.out), "#IFRAME#"]
        assert shlex.split(layer.findtext("cmd")) == [*farm, *last]
        assert [layer.findtext(key) for key in ("chunk", "cores", "memory", "gpus")] == [
            "1",
            "4.0",
            "8g",
            "1",
        ]
    waits = {(each.findtext("deplayer"), each.findtext("onlayer")) for each in spec.iter("depend")}
    assert waits == {("render", "bake"), ("assemble", "bake"), ("assemble", "render")}
    assert {each.get("type") for each in spec.iter("depend")} == {"LAYER_ON_LAYER"}
    assert spec.findtext("show") == "fire"


def test_what_is_missing_alone_is_launched_again(specification, tmp_path):
    spec = specification(write("opencue", batch(tmp_path, (4, 6, 7)))[0])
    ranges = {each.get("name"): each.findtext("range") for each in spec.iter("layer")}
    assert ranges == {"render": "4,6-7", "assemble": "1-1"}
