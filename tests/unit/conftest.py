"""Fixtures: a small run folder, as text or as .npy, that a test may damage."""

from collections.abc import Callable
from pathlib import Path

import firetwin_core as core
import pytest
from firetwin.jobs import convert
from firetwin.run import opening as runs
from firetwin_core.run import Run
from numpy.typing import NDArray
from quick_work import *  # noqa: F403
from small_run import RUN_TOML, small_fields, write_field


@pytest.fixture
def make_run(tmp_path: Path) -> Callable[..., Path]:
    """Write the small run: make_run(form, toml=..., **fields) with fields replaced, or left out for None."""

    def make(form: str = "npy", toml: str = RUN_TOML, **replaced: NDArray | None) -> Path:
        folder = tmp_path / "run"
        folder.mkdir()
        (folder / "run.toml").write_text(toml)
        for name, values in (small_fields() | replaced).items():
            if values is not None:
                write_field(folder, name, values, form)
        return folder

    return make


@pytest.fixture
def all_threads():
    """Give the cores back after a test of set_threads."""
    yield
    core.set_threads(0)


@pytest.fixture
def converted(tmp_path: Path) -> Callable[..., Run]:
    """Convert a fire model's files in this process and open the run."""

    def make(paths, start="", at="", projection="", interval=0.0):
        out = tmp_path / "run"
        convert.in_process(list(paths), out, [start, at, projection, interval])
        return runs.open(out)

    return make
