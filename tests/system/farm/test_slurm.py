"""A film by Slurm on two nodes of this machine: the pictures of one process, whatever happens to nodes."""

import time

import pytest
from farm_film import firetwin, pictures, rendered, scene
from loopback_slurm import Slurm, UnavailableError, unpacked


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    try:
        unpacked()
    except UnavailableError as error:
        pytest.skip(str(error))
    with Slurm(tmp_path_factory.mktemp("slurm") / "here", array=3) as found:
        yield found


@pytest.fixture(scope="module")
def film(run_folder, tmp_path_factory):
    """The scene file, and the film that one process makes of it."""
    folder = tmp_path_factory.mktemp("film")
    path = scene(folder / "scene.toml", run_folder)
    firetwin("render", path, "--out", folder / "one")
    return path, folder / "one"


def submit(slurm, path, out):
    """Plan and submit."""
    about = "--engine", "slurm", "--out", out, "--chunk", 2, "--submit"
    firetwin("farm", path, *about, "--", "--mem=900", environment=slurm.environment)


def until(there, seconds=300.0):
    """Wait until something is there."""
    end = time.monotonic() + seconds
    while not there():
        assert time.monotonic() < end
        time.sleep(0.2)


def test_a_film_by_two_nodes_is_that_of_one_process(slurm, film, tmp_path):
    path, one = film
    submit(slurm, path, tmp_path / "out")
    states = slurm.wait()
    assert set(states.values()) == {"COMPLETED"}, states
    assert pictures(tmp_path / "out") == pictures(one)
    assert len(rendered(tmp_path / "out")) == len(set(rendered(tmp_path / "out"))) == 21
    assert "14 of 14 pictures" in firetwin("farm", "status", tmp_path / "out")
