"""Kinds of runs: each module in this package is one, found by what is in its files.

A module says ``NAME``, what people call the format, and ``sniff(path) -> bool``, whether a file or folder is
one, from its content. That of Firetwin's own format has ``open(path) -> Run``; those of fire models have
``read(paths, options) -> Model``, and are used in a process of their own (jobs/convert.py), as damaged files
may end it.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

from firetwin_core import run
from firetwin_core.run import Run

from ...errors import Error, input_error
from . import folder

MODELS = ("wrf_sfire", "cfbm", "forefire", "elmfire", "farsite", "pyretechnics", "netcdf_cf")
"""In the order in which they are asked."""

_MANY = 200_000  # files of a folder


def open(path: str | Path) -> Run:
    """The run at `path`.

    Raises
    ------
    InputError
        There is nothing, it is a fire model's own output, of no known format, or damaged.
    """
    path = Path(path)
    if not folder.sniff(path) and foreign(path):
        reason = f"is a fire model's own output; make a run of it: firetwin convert {path} --out RUN"
        raise input_error(path, 0, 0, reason)
    return run.open(path)  # which says what is wrong


def foreign(path: Path) -> bool:
    """Whether this looks like a fire model's output, by first bytes alone: nothing of it is parsed."""
    from ..models import netcdf, raster

    def one(path: Path) -> bool:
        return netcdf.is_netcdf(path) or raster.is_raster(path) or path.suffix.lower() in (".lcp", ".npz")

    if not path.is_dir():
        return one(path)
    return not folder.sniff(path) and any(one(each) for each in path.iterdir() if each.is_file())


def gathered(paths: list[Path]) -> list[Path]:
    """Files among these, and in these folders.

    Raises
    ------
    InputError
        There is nothing, or far too much.
    """
    found: list[Path] = []
    for path in paths:
        if not path.exists():
            raise input_error(path, 0, 0, "there is no such file or folder; check the path")
        inner = [path] if path.is_file() else [each for each in sorted(path.iterdir()) if each.is_file()]
        found += [each for each in inner if each not in found]
        if len(found) > _MANY:
            raise input_error(path, 0, 0, f"holds more than {_MANY:,} files; give those of one run")
    return found


def reader(paths: list[Path]) -> ModuleType:
    """The first reader that knows one of the files.

    Raises
    ------
    Error
        None does.
    """
    broken = None
    for name in MODELS:
        module = importlib.import_module(f".{name}", __name__)
        for path in paths:
            try:
                if module.sniff(path):
                    return module
            except Error as error:  # another file may be whole
                broken = broken or error
    if broken:
        raise broken
    where = str(paths[0]) if paths else "nothing"
    raise Error(f"{where}: is of no fire model that is known; the README lists those that are")
