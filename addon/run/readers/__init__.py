"""Kinds of runs: each module in this package is one, found by what is in its files.

A module says ``NAME``, what people call the format, and ``sniff(path) -> bool``, whether a file or folder is
one, from its content. That of Firetwin's own format has ``open(path) -> Run``; those of fire models have
``read(paths, options) -> Model``, and are used in a process of their own (jobs/convert.py), as damaged files
may end it.
"""

from __future__ import annotations

import importlib
import zipfile
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
    if not path.is_dir():
        return _one(path)
    return not folder.sniff(path) and any(_one(each) for each in path.iterdir() if each.is_file())


def _one(path: Path) -> bool:
    from ..models import netcdf, raster

    return netcdf.is_netcdf(path) or raster.is_raster(path) or path.suffix.lower() in (".lcp", ".npz")


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
    if not found:
        raise input_error(paths[0], 0, 0, "is a folder without files; give that of a model's output")
    return found


def reader(paths: list[Path]) -> ModuleType:
    """The reader that knows some of the files; that of any netCDF only where no other does.

    Raises
    ------
    InputError
        None does, or they are of several runs.
    """
    from ..models import one_run

    modules = [importlib.import_module(f".{name}", __name__) for name in MODELS]
    broken: list[Error] = []
    found: dict[str, list[Path]] = {}
    for path in paths:
        try:
            known = next((module.NAME for module in modules if module.sniff(path)), None)
        except Error as error:  # another file may be whole
            broken.append(error)
            continue
        if known:
            found.setdefault(known, []).append(path)
    if len(found) > 1:
        found.pop(modules[-1].NAME, None)
    if not found:
        raise broken[0] if broken else input_error(paths[0], 0, 0, _why(paths))
    one_run.of_models(found)
    ((name, ours),) = found.items()
    one_run.of_series(ours)
    return next(module for module in modules if name == module.NAME)


def _why(paths: list[Path]) -> str:
    """What is most likely wrong with files of which none is of a known model."""
    from ..models import raster

    first = paths[0]
    if first.stat().st_size == 0:
        return "is empty; the copy or the model's run was most likely cut short"
    kind = first.suffix.lower()
    if (kind in (".nc", ".tif", ".tiff") and not _one(first)) or (
        kind == ".npz" and not zipfile.is_zipfile(first)
    ):
        return f"does not begin as a {first.suffix} file does; it is damaged or something else"
    if any(path.suffix.lower() == ".lcp" for path in paths):
        return "a landscape alone is no fire: give the arrival times of a fire on it, too"
    if kind == ".npz":
        return "has no array time_of_arrival, by which pyretechnics' output is known"
    if raster.is_raster(first):
        return (
            "a raster does not say what it holds: call arrival times time_of_arrival_0000001_0003600.tif as "
            "ELMFIRE does (s), or FIRE_Arrival Time.asc as FlamMap does (min)"
        )
    return (
        "is of no fire model that is known: WRF-SFIRE, CFBM, ForeFire, ELMFIRE, FARSITE, FlamMap, "
        "pyretechnics or netCDF with latitude and longitude"
    )
