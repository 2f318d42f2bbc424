"""The job bundle as AWS Deadline Cloud's own library reads it, and a task from the files that it sends."""

import json
import shutil
import subprocess
from pathlib import Path

import own_environment
import pytest
from farm_film import firetwin, rendered, without

PACKAGE = "deadline==0.60.10"
READER = Path(own_environment.__file__).with_name("read_bundle.py")


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    """read(bundle, status=0) -> result of the library, or its error."""
    programs = own_environment.installed("deadline", PACKAGE)
    cache = tmp_path_factory.mktemp("hashes")

    def run(bundle, status=0):
        command = [programs / "python", READER, bundle, cache]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == status, done.stderr[-3000:]
        return json.loads(done.stdout) if status == 0 else done.stderr

    return run


@pytest.fixture
def planned(film, tmp_path):
    """The scene file in a separate folder, and the output folder of its job."""
    path, out = tmp_path / "scene.toml", tmp_path / "out"
    path.write_text(film[0].read_text())
    firetwin("farm", path, "--engine", "deadline", "--out", out, "--chunk", 2)
    return path, out


def test_a_task_runs_from_the_files_that_the_bundle_sends(read, planned, tmp_path):
    path, out = planned
    template = read(out / "farm" / "deadline")
    assert template["service"] == {"maxRetriesPerTask": 3}
    assert template["job"]["Out"] == {"path": str(out)}
    assert template["job"]["Scene"] == {"path": str(path)}
    assert [each["outputs"] for each in template["roots"]] == [[str(out)]]
    there = tmp_path / "worker"
    (root,) = template["roots"]
    for name in root["inputs"]:
        (there / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(Path(root["root"]) / name, there / name)
    to_out, to_scene = (there / each.relative_to(root["root"]) for each in (out, path))
    firetwin("farm", "task", to_out, "4", "--scene", to_scene)
    assert len(rendered(to_out)) == 3


def test_what_is_submitted_again_takes_along_what_there_is(read, planned, tasks, tmp_path):
    before = read(planned[1] / "farm" / "deadline")["roots"][0]["inputs"]
    out = without(tasks, tmp_path / "again", 2, 3)
    firetwin("farm", planned[0], "--engine", "deadline", "--out", tmp_path / "x", "--chunk", 2)
    for name in ("job.json", "submitted.json"):
        shutil.copyfile(tmp_path / "x" / "farm" / name, out / "farm" / name)
    firetwin("farm", "resume", out, status=2)  # there is no deadline command here
    inputs = read(out / "farm" / "deadline")["roots"][0]["inputs"]
    more = {Path(each).name for each in inputs} - {Path(each).name for each in before}
    assert {Path(each).name for each in rendered(out)} <= more
    assert sum(each.endswith(".jsonl") for each in more) == 2
