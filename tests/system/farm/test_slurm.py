"""A film by Slurm on two nodes of this machine: equal to one process, despite faults of nodes and tasks."""

import subprocess

import pytest
from farm_film import ended, firetwin, pictures, rendered, until, without
from loopback_slurm import Slurm, UnavailableError, unpacked


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    try:
        unpacked()
    except UnavailableError as error:
        pytest.skip(str(error))
    with Slurm(tmp_path_factory.mktemp("slurm") / "here", array=3) as found:
        yield found


def running(slurm):
    """Array tasks that run, by their numbers."""
    return [job.split()[0] for job, state in slurm.states().items() if state == "RUNNING" and "_" in job]


def test_a_film_by_two_nodes_is_that_of_one_process(slurm, film, tmp_path):
    path, one = film
    out = tmp_path / "out"
    about = "--engine", "slurm", "--out", out, "--chunk", 2, "--submit"
    firetwin("farm", path, *about, "--", "--mem=900", environment=slurm.environment)
    states = slurm.wait()
    assert set(states.values()) == {"COMPLETED"}, states
    assert pictures(out) == pictures(one)
    assert len(rendered(out)) == len(set(rendered(out))) == 21
    assert "14 of 14 pictures" in firetwin("farm", "status", out)


def test_a_node_that_falls_over_and_a_requeued_task_lose_nothing(slurm, film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2, 3)
    before = len(rendered(out))
    firetwin("farm", "resume", out, environment=slurm.environment)
    until(lambda: len(running(slurm)) == 2)
    until(lambda: len(rendered(out)) > before)
    first, second = running(slurm) if len(running(slurm)) == 2 else (*running(slurm), None)
    node = slurm.call("squeue", "-h", "-j", first, "-o", "%N")
    slurm.kill_node(node)
    if second:
        slurm.call("scontrol", "requeue", second, check=False)
    until(lambda: "down" in slurm.call("sinfo", "-h", "-n", node, "-o", "%T"))
    slurm.start_node(node)
    slurm.wait()
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == len(set(rendered(out))) == 21


def test_a_cancelled_job_stays_so_until_it_is_resumed(slurm, film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2, 3)
    firetwin("farm", "resume", out, environment=slurm.environment)
    until(lambda: running(slurm))
    mine = {job for job, state in slurm.states().items() if state in ("RUNNING", "PENDING")}
    firetwin("farm", "cancel", out, environment=slurm.environment)
    states = slurm.wait()
    assert {states[job] for job in mine} == {"CANCELLED"}
    firetwin("farm", "assemble", out, status=1)
    firetwin("farm", "resume", out, environment=slurm.environment)
    slurm.wait()
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == len(set(rendered(out))) == 21


def test_a_long_film_with_a_task_whose_time_runs_out_is_that_of_one_process(slurm, long_film, tmp_path):
    path, one = long_film
    out = tmp_path / "out"
    about = "--engine", "slurm", "--out", out, "--chunk", 24, "--submit"
    firetwin("farm", path, *about, "--", "--time=30", environment=slurm.environment)
    until(lambda: rendered(out))
    task = running(slurm)[0]
    minutes = int(slurm.call("squeue", "-h", "-j", task, "-o", "%M").split(":")[-2])
    slurm.call("scontrol", "update", f"JobId={task}", f"TimeLimit={minutes + 1}")
    until(lambda: 143 in ended(out))
    slurm.call("scontrol", "update", f"JobId={task}", "TimeLimit=30")
    slurm.wait()
    assert sorted(ended(out)) == [0, 0, 0, 143]
    assert pictures(out) == pictures(one)  # with the two films
    assert len(rendered(out)) == len(set(rendered(out))) == (24 + 23) * 3


def test_a_full_disk_of_a_node_loses_nothing(slurm, film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2, 3)
    disk = slurm.disk("n0")
    mount = ["mount", "-t", "tmpfs", "-o", "size=24k", "tmpfs", disk]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("a small disk cannot be mounted here")
    try:
        firetwin("farm", "resume", out, environment=slurm.environment)
        until(lambda: 75 in ended(out))
        subprocess.run(["mount", "-o", "remount,size=64m", disk], check=True)
        slurm.wait()
    finally:
        subprocess.run(["umount", disk], check=True)
    assert sorted(ended(out))[:4] == [0] * 4
    assert set(ended(out)) == {0, 75}
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == len(set(rendered(out))) == 21
