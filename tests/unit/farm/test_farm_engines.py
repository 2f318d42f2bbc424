"""Job files of engines: graph, quoting, limits, and resubmission. No engine runs."""

import json
import shlex
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from farm_film import until
from firetwin.errors import UsageError
from firetwin.farm.engines import _engine, flamenco, htcondor, known, opencue, pbs
from firetwin.farm.engines import openjd as open_job
from small_job import BAKES, RENDERS, batch, write

FARM = [sys.executable, "-m", "firetwin", "farm"]
RECORD = """\
#!{python}
import json, sys
from pathlib import Path
log = Path({log!r})
calls = log.read_text().splitlines() if log.exists() else []
print({says!r}.format(len(calls) + 1))
log.write_text("\\n".join([*calls, json.dumps(sys.argv)]) + "\\n")
"""


SHELL = pytest.mark.posix("shell, in which schedulers run tasks")


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """Commands that record their calls: asked(outputs, names...) -> a function that returns the calls."""

    def make(says, *names):
        place, log = tmp_path / "bin", tmp_path / "calls.txt"
        place.mkdir()
        for name in names:
            text = RECORD.format(python=sys.executable, log=str(log), says=says)
            (place / name).write_text(text)
            (place / name).chmod(0o755)
        monkeypatch.setenv("PATH", f"{place}:/usr/bin:/bin")
        return lambda: [
            [Path(each[0]).name, *each[1:]] for each in map(json.loads, log.read_text().splitlines())
        ]

    return make


def test_inside_of_blender_its_executable_runs_tasks(monkeypatch):
    blender = SimpleNamespace(app=SimpleNamespace(binary_path=""))  # as a module
    monkeypatch.setitem(sys.modules, "bpy", blender)
    assert _engine.firetwin_command() == [sys.executable, "-m", "firetwin"]
    blender.app.binary_path = "/opt/blender"
    program, *options, last = _engine.firetwin_command()
    assert (program, options[-1], last) == ("/opt/blender", "--command", "firetwin")


def test_workers_of_deadline_run_their_own_blender_or_python(monkeypatch, tmp_path):
    for path, program, first in (("", "python", "-m"), ("/opt/blender", "blender", "--background")):
        bpy = SimpleNamespace(app=SimpleNamespace(binary_path=path))
        monkeypatch.setitem(sys.modules, "bpy", bpy)
        folder, _ = write("deadline", batch(tmp_path))
        values = json.loads((folder / "parameter_values.json").read_text())["parameterValues"]
        assert {"name": "Program", "value": program} in values
        step = json.loads((folder / "template.json").read_text())["steps"][0]
        assert step["script"]["actions"]["onRun"]["args"][0] == first


@pytest.mark.parametrize("name", known())
def test_what_was_never_submitted_is_not_cancelled(name, tmp_path):
    with pytest.raises(UsageError):
        known()[name]().cancel(tmp_path)


@SHELL
def test_pbs_has_an_array_for_each_stage_and_holds_the_first(tmp_path, asked):
    calls = asked("{}[].server", "qsub", "qrls")
    folder, command = write("pbs", batch(tmp_path, options=("-A", "the project")))
    subprocess.run(command, check=True)
    common = ["qsub", "-r", "y", "-j", "oe", "-A", "the project"]
    assert calls() == [
        [*common, "-h", "-J", "0-1", "-N", "firetwin-bake", "bake-1.sh"],
        [*common, "-W", "depend=afterok:1[].server", "-J", "0-4", "-N", "firetwin-render", "render-1.sh"],
        [*common, "-W", "depend=afterany:1[].server:2[].server", "-N", "firetwin-film", "assemble.sh"],
        ["qrls", "1[].server"],
    ]
    assert (folder / "jobs.txt").read_text().split() == ["1[].server", "2[].server", "3[].server"]


@SHELL
def test_pbs_submits_what_is_missing_and_splits_at_its_limit(tmp_path, asked, monkeypatch):
    calls = asked("{}[].server", "qsub", "qrls")
    monkeypatch.setattr(pbs, "max_array_size", lambda: 2)
    subprocess.run(write("pbs", batch(tmp_path, (3, 5, 6)))[1], check=True)
    common = ["-r", "y", "-j", "oe"]
    assert [each[1:] for each in calls()] == [
        [*common, "-h", "-J", "0-1", "-N", "firetwin-render", "render-1.sh"],
        [*common, "-h", "-N", "firetwin-render", "render-2.sh"],  # an array of one is none
        [*common, "-W", "depend=afterany:1[].server:2[].server", "-N", "firetwin-film", "assemble.sh"],
        ["1[].server", "2[].server"],
    ]


@SHELL
@pytest.mark.parametrize(("engine", "program"), [("pbs", "qsub"), ("slurm", "sbatch")])
def test_a_submission_that_fails_is_the_last(engine, program, tmp_path, monkeypatch):
    calls = tmp_path / "calls.txt"
    (tmp_path / program).write_text(f"#!/bin/sh\necho called >>'{calls}'\nexit 3\n")
    (tmp_path / program).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    assert subprocess.run(write(engine, batch(tmp_path))[1]).returncode == 3
    assert calls.read_text() == "called\n"


@pytest.fixture
def pbs_script(tmp_path, monkeypatch):
    """Start a script of tasks 3, 5 and 6; 5 ends with 75: pbs_script(pause, index) -> process, its log."""
    program = tmp_path / "firetwin"
    program.write_text(
        f"#!{sys.executable}\nimport sys\nprint(sys.argv[1:])\nsys.exit(75 if '5' in sys.argv else 1)\n"
    )
    program.chmod(0o755)
    monkeypatch.setattr(pbs, "firetwin_command", lambda: [str(program)])

    def start(pause, index):
        monkeypatch.setattr(pbs, "_PAUSE", pause)
        folder, _ = write("pbs", batch(tmp_path, (3, 5, 6)))
        script = ["env", f"PBS_ARRAY_INDEX={index}", "bash", folder / "render-1.sh"]
        return subprocess.Popen(script), folder / "log" / f"render-{(3, 5, 6)[index]}.out"

    return start


@SHELL
def test_pbs_tasks_run_the_number_at_their_index(tmp_path, pbs_script):
    for index, number, status, tries in ((1, 5, 75, 3), (2, 6, 1, 1)):
        process, log = pbs_script(0, index)
        assert process.wait() == status
        command = ["farm", "task", str(batch(tmp_path).out), str(number)]
        assert log.read_text().splitlines() == [str(command)] * tries


@SHELL
def test_a_pbs_task_that_is_told_to_end_does_not_try_again(pbs_script):
    process, log = pbs_script(60, 1)
    until(lambda: log.exists() and log.read_text().count("\n") == 1, 20)
    time.sleep(0.5)  # into the pause
    process.terminate()
    assert process.wait(20) == 75
    assert log.read_text().count("\n") == 1


@SHELL
def test_flamenco_has_the_tasks_as_settings(tmp_path, asked):
    calls = asked('{{"id": "12-ab"}}', "curl")
    folder, command = write("flamenco", batch(tmp_path, (4, 6, 7), ("http://farm:8080", "-k")))
    settings = json.loads((folder / "job.json").read_text())["settings"]
    assert (settings["bakes"], settings["renders"]) == ("", "4,6-7")
    assert json.loads(settings["command"]) == FARM[:-1]
    (folder / "submitted.json").write_text('{"activity":"","id":"12-ab","name":"x","tag":{"id":"7"}}')
    subprocess.run(command, check=True)
    assert [each[-3:] for each in calls()] == [
        ["job_type.json", "-k", "http://farm:8080/api/v3/jobs/type/firetwin"],
        ["submitted.json", "-k", "http://farm:8080/api/v3/jobs"],
    ]
    cancel = flamenco.Flamenco().cancel(folder.parents[1])
    assert cancel[-1] == "http://farm:8080/api/v3/jobs/12-ab/setstatus"


def test_opencue_has_the_stages_as_layers(tmp_path):
    whole = batch(tmp_path, (*BAKES, 3, 5))
    folder, command = write("opencue", whole)
    assert command == ["python3", str(folder / "launch.py")]
    found = opencue.list_layers(whole)
    assert repr(found) in (folder / "launch.py").read_text()
    tasks = [*FARM, "task", str(whole.out), "#IFRAME#"]
    assert [(name, shlex.split(text), frames) for name, text, frames in found] == [
        ("bake", tasks, "1-2"),
        ("render", tasks, "3,5"),
        ("assemble", [*FARM, "assemble", str(whole.out)], "1-1"),
    ]


def dag(folder):
    """Numbers of the nodes, edges between them and the final node of a DAG."""
    lines = [shlex.split(line) for line in (folder / "film.dag").read_text().splitlines()]
    nodes = {line[1]: line[3] for line in lines if line[0] == "VARS"}
    assert {line[1] for line in lines if line[0] == "JOB"} == set(nodes)
    edges = set()
    for line in lines:
        if line[0] == "PARENT":
            at = line.index("CHILD")
            edges |= {(before, after) for before in line[1:at] for after in line[at + 1 :]}
    return nodes, edges, [line[1:] for line in lines if line[0] == "FINAL"]


def test_htcondor_has_a_node_for_each_task(tmp_path):
    folder, _ = write("htcondor", batch(tmp_path, options=("request_gpus = 1", "-maxjobs", "9")))
    nodes, edges, final = dag(folder)
    assert nodes == {f"t{number}": f"number={number}" for number in BAKES + RENDERS}
    assert edges == {(f"t{before}", f"t{after}") for before in BAKES for after in RENDERS}
    assert final == [["assemble", "assemble.sub"]]
    assert "\nrequest_gpus = 1\n" in (folder / "task.sub").read_text()
    assert " -maxjobs 9 " in (folder / "submit.sh").read_text()
    nodes, edges, final = dag(write("htcondor", batch(tmp_path, (4, 6)))[0])
    assert (set(nodes), edges, len(final)) == ({"t4", "t6"}, set(), 1)


def test_htcondor_quotes_arguments():
    quoted = {
        "plain": "'plain'",
        "it's a film": "'it''s a film'",
        'a "b"': '\'a ""b""\'',
        "$(x)": "'$(DOLLAR)(x)'",
    }
    assert {text: htcondor.quote_argument(text) for text in quoted} == quoted


@pytest.mark.parametrize("text", ["film\nqueue 99", "film\rx", "film\x1b"])
def test_htcondor_refuses_a_folder_or_an_option_of_several_lines(tmp_path, text):
    for job in (batch(tmp_path / text), batch(tmp_path, options=(f"a = {text}",))):
        with pytest.raises(UsageError, match="choose a name of one line"):
            write("htcondor", job)


def test_htcondor_refuses_a_folder_that_it_takes_for_a_macro(tmp_path):
    with pytest.raises(UsageError, match="another --out"):
        write("htcondor", batch(tmp_path / "$(film)"))


HOSTS = ("os=linux", "memory=1.5G", "gpus=1", "gpu_memory=8G", "cores=4")


def test_host_requirements_are_options_with_an_equals_sign(tmp_path):
    steps = {each["name"]: each for each in open_job.template(batch(tmp_path, options=HOSTS))["steps"]}
    render = steps["Render"]["hostRequirements"]
    assert render["attributes"] == [{"name": "attr.worker.os.family", "anyOf": ["linux"]}]
    assert {each["name"]: each["min"] for each in render["amounts"]} == {
        "amount.worker.memory": 1536,
        "amount.worker.gpu": 1,
        "amount.worker.gpu.memory": 8192,
        "amount.worker.vcpu": 4,
    }
    for name in ("Bake", "Assemble"):
        assert len(steps[name]["hostRequirements"]["amounts"]) == 2  # no GPU
    assert open_job.split_options((*HOSTS, "--farm-id", "a=b"))[1] == ["--farm-id", "a=b"]
    assert "hostRequirements" not in str(open_job.template(batch(tmp_path)))


@pytest.mark.parametrize("wrong", ["os=amiga", "memory=much", "gpus=0"])
def test_invalid_host_requirements_are_refused(wrong):
    with pytest.raises(UsageError, match="write"):
        open_job.split_options((wrong,))
