"""A film of two cameras made by one process, and the same made task by task."""

import pytest
from farm_film import firetwin, flow_scene, pictures, scene


@pytest.fixture(scope="session")
def film(run_folder, tmp_path_factory):
    """The scene file, and the film that one process makes of it."""
    folder = tmp_path_factory.mktemp("film")
    path = scene(folder / "scene.toml", run_folder)
    firetwin("render", path, "--out", folder / "one")
    return path, folder / "one"


@pytest.fixture(scope="session")
def tasks(film, tmp_path_factory):
    """The film's folder once all tasks have run, one after the other, and are assembled."""
    out = tmp_path_factory.mktemp("tasks") / "out"
    firetwin("farm", film[0], "--engine", "slurm", "--out", out, "--chunk", 2)
    assert "4 waiting" in firetwin("farm", "status", out)
    firetwin("farm", "task", out, "1-4")
    firetwin("farm", "assemble", out)
    return out


@pytest.fixture(scope="session")
def long_film(run_folder, tmp_path_factory):
    """The scene file of 24 frames of two cameras with smoke of a flow, and the film of one process."""
    folder = tmp_path_factory.mktemp("long")
    path = flow_scene(folder / "scene.toml", run_folder)
    firetwin("render", path, "--out", folder / "one")
    found = pictures(folder / "one")
    assert len([name for name in found if name.endswith(".mp4")]) == 2
    assert len(found) == (24 + 23) * 3 + 2
    return path, folder / "one"
