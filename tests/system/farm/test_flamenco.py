"""The job type for Flamenco, compiled by the interpreter that its Manager embeds."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from small_job import BAKES, RENDERS, batch, write

GOJA = "github.com/dop251/goja@v0.0.0-20230812105242-81d76064690d"  # of Flamenco 3
PLACE = Path(__file__).parents[3] / "build" / "flamenco"
SOURCE = Path(__file__).parent / "compile_job" / "main.go"


@pytest.fixture(scope="module")
def compiled():
    """Compile the files of an engine: compiled(folder) -> tasks by name."""
    if not shutil.which("go"):
        pytest.skip("there is no Go here (Debian: golang-go)")
    PLACE.mkdir(parents=True, exist_ok=True)
    shutil.copy(SOURCE, PLACE)
    steps = [["go", "get", GOJA], ["go", "build", "-o", "compile_job", "."]]
    if not (PLACE / "go.mod").exists():
        steps.insert(0, ["go", "mod", "init", "firetwin/compile_job"])
    for step in steps:
        done = subprocess.run(step, cwd=PLACE, env=os.environ | {"GOFLAGS": "-mod=mod"}, capture_output=True)
        if done.returncode:
            pytest.skip(f"{' '.join(step)}: {done.stderr.decode().strip()[-300:]}")

    def run(folder):
        command = [PLACE / "compile_job", folder / "firetwin.js", folder / "job.json"]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return {each["Name"]: each for each in json.loads(done.stdout)}

    return run


def test_tasks_of_the_job_type_are_those_of_the_plan(compiled, tmp_path):
    whole = batch(tmp_path)
    tasks = compiled(write("flamenco", whole)[0])
    bakes, renders = [f"bake-{n}" for n in BAKES], [f"render-{n}" for n in RENDERS]
    waits = {name: task["Before"] or [] for name, task in tasks.items()}
    expected = {each: [] for each in bakes} | {each: bakes for each in renders}
    assert waits == expected | {"assemble": bakes + renders}
    for name, task in tasks.items():
        (command,) = task["Commands"]
        verb, number = ("task", [name.partition("-")[2]]) if "-" in name else ("assemble", [])
        about = {"exe": sys.executable, "args": ["-m", "firetwin", "farm", verb, str(whole.out), *number]}
        assert (command["Name"], command["Parameters"]) == ("exec", about)
    assert {task["Type"] for task in tasks.values()} == {"blender", "misc"}


def test_what_is_missing_alone_is_submitted_again(compiled, tmp_path):
    tasks = compiled(write("flamenco", batch(tmp_path, (4, 6)))[0])
    waits = {name: task["Before"] or [] for name, task in tasks.items()}
    assert waits == {"render-4": [], "render-6": [], "assemble": ["render-4", "render-6"]}
    assert list(compiled(write("flamenco", batch(tmp_path, ()))[0])) == ["assemble"]
