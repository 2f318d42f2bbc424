"""A film by Open Job Description's own command: its job is checked, run, and run where paths are others."""

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from farm_film import firetwin, pictures, rendered

VERSION = "0.8.0"
PLACE = Path(__file__).parents[3] / "build" / "openjd"


@pytest.fixture(scope="module")
def openjd():
    """Run openjd-cli from a virtual environment of its own: openjd(arguments...) -> what it prints."""
    if not (PLACE / "bin" / "openjd").exists():
        made = [sys.executable, "-m", "venv", PLACE]
        got = [PLACE / "bin" / "pip", "install", "-q", f"openjd-cli=={VERSION}"]
        for each in (made, got):
            done = subprocess.run(each, capture_output=True, text=True)
            if done.returncode:
                pytest.skip(f"openjd-cli cannot be installed here: {done.stderr.strip()[-300:]}")

    def run(*arguments):
        command = [PLACE / "bin" / "openjd", *arguments]
        done = subprocess.run(command, env=dict(os.environ), capture_output=True, text=True)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
        return done.stdout

    return run


def plan(engine, path, out):
    """Plan a film; arguments of the engine's command."""
    return shlex.split(firetwin("farm", path, "--engine", engine, "--out", out, "--chunk", 2))[1:]


@pytest.mark.parametrize("engine", ["openjd", "deadline"])
def test_templates_are_what_the_specification_asks_for(openjd, film, tmp_path, engine):
    path = tmp_path / "scene.toml"
    path.write_text(film[0].read_text().replace('"puffs"', '"flow"'))  # with a bake
    plan(engine, path, tmp_path / "out")
    template = tmp_path / "out" / "farm" / engine / "template.json"
    openjd("check", template)
    assert [step["name"] for step in json.loads(template.read_text())["steps"]] == [
        "Bake",
        "Render",
        "Assemble",
    ]


def test_a_film_by_openjd_is_that_of_one_process(openjd, film, tmp_path):
    path, one = film
    out = tmp_path / "out"
    said = openjd(*plan("openjd", path, out))
    assert "openjd_progress: 100.0" in said
    assert pictures(out) == pictures(one)
    assert len(rendered(out)) == len(set(rendered(out))) == 21


def test_a_task_finds_its_files_where_an_engine_has_mapped_them(openjd, film, tmp_path):
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    (here / "scene.toml").write_text(film[0].read_text())
    command = plan("openjd", here / "scene.toml", here / "out")
    here.rename(there)
    rule = {"source_path_format": "POSIX", "source_path": str(here), "destination_path": str(there)}
    rules = json.dumps({"version": "pathmapping-1.0", "path_mapping_rules": [rule]})
    moved = [each.replace(str(here), str(there)) for each in command]  # values in the file stay
    last = json.dumps([{"Tasks": "4-4"}])
    openjd(*moved, "--path-mapping-rules", rules, "--step", "Render", "--tasks", last)
    assert len(rendered(there / "out")) == 3
    assert not here.exists()
