"""A film of two cameras made by one process, and the same made task by task; all tests share them."""

import pytest
from farm_film import firetwin, flow_scene, pictures, scene
from made_once import made_once


@pytest.fixture(scope="session")
def film(run_folder, tmp_path_factory):
    """The scene file, and the film that one process makes of it."""

    def make(folder):
        firetwin("render", scene(folder / "scene.toml", run_folder), "--out", folder / "one")

    folder = made_once(tmp_path_factory, "film", make)
    return folder / "scene.toml", folder / "one"


@pytest.fixture(scope="session")
def tasks(film, tmp_path_factory):
    """The film's folder once all tasks have run, one after the other, and are assembled."""

    def make(folder):
        out = folder / "out"
        firetwin("farm", film[0], "--engine", "slurm", "--out", out, "--chunk", 2)
        assert "4 waiting" in firetwin("farm", "status", out)
        firetwin("farm", "task", out, "1-4")
        firetwin("farm", "assemble", out)

    return made_once(tmp_path_factory, "tasks", make) / "out"


@pytest.fixture(scope="session")
def long_film(run_folder, tmp_path_factory):
    """The scene file of 24 frames of two cameras with smoke of a flow, and the film of one process."""

    def make(folder):
        firetwin("render", flow_scene(folder / "scene.toml", run_folder), "--out", folder / "one")

    folder = made_once(tmp_path_factory, "long_film", make)
    found = pictures(folder / "one")
    assert len([name for name in found if name.endswith(".mp4")]) == 2
    assert len(found) == (24 + 23) * 3 + 2
    return folder / "scene.toml", folder / "one"
