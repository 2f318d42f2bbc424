"""Assets of a job: all files that its tasks read; pictures of these files alone; missing files are named."""

import json
import shutil
from pathlib import Path

import farm_inputs
import pytest
from farm_film import firetwin, pictures


@pytest.fixture(scope="module")
def here(run_folder, tmp_path_factory):
    """The scene file in a folder with its assets and other files."""
    return farm_inputs.write(tmp_path_factory.mktemp("inputs") / "here", run_folder)


def listed(out: Path) -> list[str]:
    return json.loads((out / "farm" / "job.json").read_text())["assets"]


def test_a_task_needs_nothing_but_what_its_job_lists(here, tmp_path):
    out, bare = tmp_path / "out", tmp_path / "bare"
    firetwin("farm", here, "--engine", "deadline", "--out", out)
    places = {Path(each).relative_to(here.parent).as_posix() for each in listed(out)}
    run = {f"run/{path.name}" for path in (here.parent / "run").glob("*.npy")} | {"run/run.toml"}
    assert places == {"scene.toml", *run, *farm_inputs.NAMED}
    for place in places:
        (bare / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(here.parent / place, bare / place)
    shutil.copytree(out, tmp_path / "moved")
    firetwin("render", here, "--out", tmp_path / "one")
    away = here.parent.rename(tmp_path / "away")  # a task that looks there finds nothing
    try:
        moved = tmp_path / "moved"
        for verb in (("task", moved, "1-2"), ("assemble", moved)):
            firetwin("farm", *verb, "--scene", bare / "scene.toml")
    finally:
        away.rename(here.parent)
    assert pictures(moved) == pictures(tmp_path / "one")
    assert len(pictures(moved)) == 2 * 2
