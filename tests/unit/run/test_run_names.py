"""Runs in folders and with files whose names are not UTF-8."""

import os
import subprocess
import sys
from pathlib import Path

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core.flux import at_time
from firetwin_core.run import read_grid

pytestmark = pytest.mark.posix("names that are not Unicode")

ODD = "run\udcff"


@pytest.fixture(params=["npy", "text"])
def odd(request, make_run, tmp_path):
    """The small run in a folder whose name is not UTF-8, and that run.toml gives no name."""
    folder = make_run(request.param)
    manifest = folder / "run.toml"
    manifest.write_text("".join(manifest.read_text().splitlines(keepends=True)[1:]))
    moved = tmp_path / ODD
    try:
        folder.rename(moved)
    except OSError:
        pytest.skip("this file system takes no such name")
    return moved


def test_everything_can_be_read(odd):
    run = runs.open(odd)
    assert Path(run.path) == odd
    assert list(Path(run.path).iterdir())
    assert run.name == "run\\xff"
    assert "run\\xff" in repr(run)
    assert run.warnings == []
    assert run.heat_flux(1)[1, 2] == 1000.5
    assert sum(1 for _ in run.frames()) == 3
    assert at_time(run, 90.0).any()
    assert np.isfinite(run.arrival_time()).any()
    assert runs.open(os.fsencode(odd)).flux_range() == (0.0, 2000.25)


def test_strange_files_are_named(odd):
    (odd / os.fsdecode(b"n\xe9.txt")).write_text("1")
    assert runs.open(odd).warnings == ["n\\xe9.txt is not a field of a run and is ignored"]


def test_errors_name_the_file(odd):
    (odd / "run.toml").write_text('start = "x"\n')
    with pytest.raises(core.InputError, match=r"run\\xff/run\.toml:1") as caught:
        runs.open(odd)
    assert caught.value.path.endswith("run\\xff/run.toml")
    caught.value.path.encode()
    with pytest.raises(core.InputError, match=r"run\\xff/no/such"):
        runs.open(odd / "no" / "such")
    with pytest.raises(core.InputError, match=r"run\\xff/none\.txt"):
        read_grid(odd / "none.txt")


def info(odd, *options, encoding="utf-8"):
    command = [sys.executable, "-m", "firetwin", "info", *options, os.fsencode(odd)]
    environment = os.environ | {"PYTHONIOENCODING": f"{encoding}:strict"}
    return subprocess.run(command, capture_output=True, timeout=120, env=environment)


@pytest.mark.parametrize("odd", ["npy"], indirect=True)
def test_the_command_tells_about_it(odd):
    for encoding, options, said in (("utf-8", (), b"run\xff"), ("ascii", ("--json",), rb"run\udcff")):
        result = info(odd, *options, encoding=encoding)
        assert result.returncode == 0, result.stderr
        assert said in result.stdout


@pytest.mark.parametrize("odd", ["text"], indirect=True)
def test_the_command_names_it_in_errors(odd):
    assert b"run\xff" in info(odd, encoding="ascii").stdout
    (odd / "run.toml").unlink()
    result = info(odd)
    assert result.returncode == 1
    assert b"run\\xff/run.toml: the file is missing" in result.stderr
