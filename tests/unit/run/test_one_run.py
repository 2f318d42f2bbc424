"""Files of two runs are rejected, and each run has a separate name."""

import os
import re

import model_files as made
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.jobs import convert
from firetwin.run import opening as runs
from firetwin.run import readers

ARRIVAL = np.hypot(*np.mgrid[-8:9, -8:9]) * 30.0


def archive(path):
    np.savez(path, time_of_arrival=ARRIVAL / 60, cell_width=30.0, cell_height=30.0)
    return path


def converted(paths, out, **said):
    words = [said.get(name, "") for name in ("start", "at", "projection")] + [0.0]
    words += [said.get("name", ""), said.get("zone", "")]
    convert.in_process(list(paths), out, words)
    return runs.open(out)


def test_files_of_two_models_are_refused_by_name(tmp_path):
    paths = [made.forefire(tmp_path / "ForeFire.0.nc", ARRIVAL), archive(tmp_path / "a.npz")]
    with pytest.raises(InputError, match=r"a\.npz: is arrays of pyretechnics where ForeFire\.0\.nc is"):
        readers.reader(paths)


def test_two_maps_are_refused(tmp_path):
    maps = [made.forefire(tmp_path / f"ForeFire.{k}.nc", ARRIVAL) for k in (0, 1)]
    archives = [archive(tmp_path / name) for name in ("a.npz", "b.npz")]
    for paths, name in ((maps, r"ForeFire\.1\.nc"), (archives, r"b\.npz")):
        with pytest.raises(InputError, match=f"{name}: is another run than"):
            converted(paths, tmp_path / "out", start="2020-07-01")


def test_two_places_are_refused(tmp_path):
    """Two series of the same size and of other times."""
    paths = made.cfbm(tmp_path, count=2, shape=(8, 9))[0]
    far = paths[-1].with_name("fire_output_2033-01-01_00:00:00.nc")
    far.write_bytes(paths[-1].read_bytes())
    with made.netCDF4.Dataset(far, "a") as file:
        file["lats"][:] += 1.0
    with pytest.raises(InputError, match=r"fire_output_2033.*another place; convert one run at a time"):
        readers.reader([*paths, far])
    assert readers.reader(paths).NAME.endswith("Community Fire Behavior Model")


def test_files_of_one_name_are_of_two_runs(tmp_path):
    folders = [tmp_path / name for name in ("a", "b")]
    for folder in folders:
        folder.mkdir()
    paths = [path for folder in folders for path in made.cfbm(folder, count=2, shape=(8, 9))[0]]
    first = re.escape(os.sep.join(["", "a", "fire_output"]))
    with pytest.raises(InputError, match=f"has the name of .*{first}.*, so it is of another run"):
        readers.reader(paths)


def test_each_run_has_its_own_name_and_zone(tmp_path):
    paths = made.cfbm(tmp_path, count=2, shape=(8, 9))[0]
    names = {converted(paths, tmp_path / out).name for out in ("calm", "windy")}
    assert len(names) == 2
    assert all(folder in " ".join(names) for folder in ("calm", "windy"))
    run = converted(paths, tmp_path / "asked", name='The "great" fire', zone="Europe/Paris")
    assert (run.name, run.zone) == ('The "great" fire', "Europe/Paris")
