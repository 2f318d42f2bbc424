"""A film of two cameras made by one process, and the same made task by task."""

import pytest
from farm_film import firetwin, scene


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
