"""A film by HTCondor's DAGMan on a pool of this machine: equal to one process, also after a removal."""

import shlex
import shutil
import subprocess

import pytest
from farm_film import firetwin, pictures, rendered, until, without
from firetwin.farm.engines import htcondor
from personal_condor import Condor, UnavailableError, prepare
from small_job import batch, write


@pytest.fixture(scope="module")
def condor():
    try:
        prepare()
    except UnavailableError as error:
        pytest.skip(str(error))
    with Condor() as found:
        yield found


def test_a_film_by_dagman_is_that_of_one_process(condor, film):
    path, one = film
    out = condor.films / "the film's out"
    about = "--engine", "htcondor", "--out", out, "--chunk", 2, "--submit"
    firetwin("farm", path, *about, "--", "request_memory = 900", environment=condor.environment)
    condor.wait()
    said = {each.name: each.read_text() for each in (out / "farm" / "htcondor" / "log").glob("*.out")}
    assert set(said) == {f"render-{number}.out" for number in range(1, 5)} | {"assemble.out"}
    assert (out / "manifest.json").exists(), said
    assert pictures(out) == pictures(one)
    assert len(rendered(out)) == len(set(rendered(out))) == 21
    (out / "manifest.json").unlink()
    firetwin("farm", "resume", out, environment=condor.environment)  # nothing but the final node
    condor.wait()
    assert pictures(out) == pictures(one)


def test_a_removed_job_is_resumed_with_what_is_missing(condor, film, tasks, tmp_path):
    out = condor.films / "removed"
    shutil.move(without(tasks, tmp_path / "out", 2, 3), out)
    (out / "farm" / "submitted.json").write_text('{"engine": "htcondor", "options": []}')
    firetwin("farm", "resume", out, environment=condor.environment)
    until(lambda: any(out.glob("farm/entries/0000[23]-*.jsonl")))
    firetwin("farm", "cancel", out, environment=condor.environment)
    condor.wait()
    assert any(state in firetwin("farm", "status", out) for state in ("1 failed", "2 failed", "1 waiting"))
    firetwin("farm", "resume", out, environment=condor.environment)
    condor.wait()
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == len(set(rendered(out))) == 21


def test_a_task_with_wrong_input_runs_once_and_the_final_node_still_runs(condor, film, tasks, tmp_path):
    out = condor.films / "wrong"
    shutil.move(without(tasks, tmp_path / "out", 3), out)
    command = firetwin("farm", film[0], "--engine", "htcondor", "--out", out, "--chunk", 2)
    dag = out / "farm" / "htcondor" / "film.dag"
    dag.write_text(dag.read_text().replace('number="3"', 'number="99"'))
    subprocess.run(shlex.split(command), env=condor.environment, check=True)
    condor.wait()
    log = out / "farm" / "htcondor" / "log"
    assert (log / "render-99.out").read_text().count("task 99 does not exist") == 1
    assert "not rendered" in (log / "assemble.out").read_text()


def stand_in(folder, code):
    """Have tasks run some Python instead; $(number) in it is theirs."""
    lines = (folder / "task.sub").read_text().splitlines()
    end = f"""arguments = "'-c' '{code}'" """
    text = "\n".join(end if line.startswith("arguments") else line for line in lines)
    (folder / "task.sub").write_text(text + "\n")


def test_a_task_without_a_device_is_tried_again(condor):
    folder, command = write("htcondor", batch(condor.films))  # bakes, renders, the final node
    stand_in(folder, "import sys; sys.exit(2 if $(number) == 1 else 75)")
    subprocess.run(command, env=condor.environment, check=True)
    condor.wait()
    log = (folder / "log" / "nodes.log").read_text()
    assert log.count("Job executing on host") == 1 + 4 + 1  # no render after a bake that failed
    assert "no farm job in this folder" in (folder / "log" / "assemble.out").read_text()


def test_a_removed_task_is_told_to_end_and_the_final_node_runs(condor):
    removed = batch(condor.films / "told", (1,))
    folder, command = write("htcondor", removed)
    told = "lambda *_: (print(7 * 191, flush=True), sys.exit(143))"
    stand_in(folder, f"import signal, sys; signal.signal(15, {told}); print(1, flush=True); signal.pause()")
    subprocess.run(command, env=condor.environment, check=True)
    log = folder / "log" / "bake-1.out"
    until(lambda: log.exists() and log.read_text() == "1\n")
    subprocess.run(htcondor.HTCondor().cancel(removed.out), env=condor.environment, check=True)
    condor.wait()
    assert log.read_text() == "1\n1337\n"
    assert (folder / "log" / "assemble.out").exists()
