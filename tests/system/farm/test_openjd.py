"""A film by Open Job Description's own command: its job is checked, run, and run where paths are others."""

import json
import shlex
import signal
import subprocess

import own_environment
import pytest
from farm_film import ended, firetwin, pictures, rendered, until

PACKAGE = "openjd-cli==0.8.0"


@pytest.fixture(scope="module")
def openjd():
    """Run openjd-cli in its environment: openjd(arguments...) -> its output; openjd.start(...)."""
    programs = own_environment.installed("openjd", PACKAGE)

    def start(*arguments):
        command = [programs / "openjd", *arguments]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(*arguments):
        done = start(*arguments)
        said, errors = done.communicate()
        assert done.returncode == 0, said[-3000:] + errors[-3000:]
        return said

    run.start = start
    return run


def plan(engine, path, out, *options):
    """Plan a film; arguments of the scheduler's command."""
    more = ("--", *options) if options else ()
    return shlex.split(firetwin("farm", path, "--engine", engine, "--out", out, "--chunk", 2, *more))[1:]


@pytest.mark.parametrize("engine", ["openjd", "deadline"])
def test_templates_are_what_the_specification_asks_for(openjd, film, tmp_path, engine):
    path = tmp_path / "scene.toml"
    path.write_text(film[0].read_text().replace("enabled = false", "enabled = true"))  # with a bake
    plan(engine, path, tmp_path / "out", "os=linux", "memory=16G", "gpus=1", "gpu_memory=8G")
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


def test_a_long_film_that_is_cancelled_twice_is_that_of_one_process(openjd, long_film, tmp_path):
    path, one = long_film
    out = tmp_path / "out"
    arguments = shlex.split(firetwin("farm", path, "--engine", "openjd", "--out", out, "--chunk", 6))[1:]
    for end in (signal.SIGINT, signal.SIGTERM):
        before = len(rendered(out)) if (out / "farm" / "entries").exists() else 0
        run = openjd.start(*arguments)
        until(lambda before=before: len(rendered(out)) >= before + 4)
        run.send_signal(end)
        said = run.communicate(timeout=120)
        assert run.returncode != 0, said
    assert ended(out).count(143) == 2
    assert len(rendered(out)) < (24 + 23) * 3
    openjd(*arguments)
    assert pictures(out) == pictures(one)  # with the two films
    assert len(rendered(out)) == len(set(rendered(out))) == (24 + 23) * 3


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
