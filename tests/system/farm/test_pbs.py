"""A film by the scripts for PBS, run by the qsub, qrls, qstat and qdel of Slurm: PBS is not to be had."""

import pytest
from farm_film import firetwin, pictures, rendered, until, without
from loopback_slurm import Slurm, UnavailableError, unpack_pbs


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    try:
        unpack_pbs()
    except UnavailableError as error:
        pytest.skip(str(error))
    with Slurm(tmp_path_factory.mktemp("pbs") / "here") as found:
        yield found


def test_a_film_by_qsub_is_that_of_one_process(slurm, film, tmp_path):
    path, one = film
    out = tmp_path / "the out"
    about = "--engine", "pbs", "--out", out, "--chunk", 2, "--submit"
    said = firetwin("farm", path, *about, "--", "-l", "mem=900mb", environment=slurm.environment)
    states = slurm.wait()
    assert set(states.values()) == {"COMPLETED"}, (said, states)
    assert pictures(out) == pictures(one)
    assert len(rendered(out)) == len(set(rendered(out))) == 21
    assert {name.split()[1] for name in states} == {"firetwin-render", "firetwin-film"}


def test_a_deleted_job_is_resumed_with_what_is_missing(slurm, film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2, 3)
    (out / "farm" / "submitted.json").write_text('{"engine": "pbs", "options": []}')
    firetwin("farm", "resume", out, environment=slurm.environment)
    until(lambda: "RUNNING" in slurm.states().values())
    numbers = (out / "farm" / "pbs" / "jobs.txt").read_text().split()
    firetwin("farm", "cancel", out, environment=slurm.environment)
    ended = {job.split()[0].partition("_")[0]: state for job, state in slurm.wait().items()}
    assert {ended[number] for number in numbers} == {"CANCELLED"}, ended
    firetwin("farm", "assemble", out, status=1)
    firetwin("farm", "resume", out, environment=slurm.environment)
    slurm.wait()
    assert pictures(out) == pictures(film[1])
