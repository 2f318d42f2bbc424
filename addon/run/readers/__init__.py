"""Readers of run formats: each module in this package reads one, recognised by file content.

A module has ``NAME``, the format's name for people, and ``sniff(path) -> bool``, whether a file or folder has
the format. Firetwin's own format has ``open(path) -> Run``. Those of fire models have ``read(paths, options)
-> Model``, and are tried in the order of ``ORDER``. They run in a separate process (jobs/convert.py), as
damaged files can crash it. A module can also have

- ``resembles(path) -> bool``, which checks first bytes or suffix, also of folders; without it, ``sniff``
- ``MODELS``, the models in the list of known formats; without it, ``NAME``
- ``RASTER``, how a raster of arrival times is named, if the name identifies it
- ``why(paths) -> str``, why no reader recognises files that it resembles; empty for other files
"""

from __future__ import annotations

import functools
import zipfile
from pathlib import Path
from types import ModuleType

from firetwin_core.run import Run

from ... import plugins
from ...errors import Error, input_error, reading
from .. import bounds, opening
from . import folder

_MANY = 200_000  # files of a folder


@functools.cache
def models() -> tuple[ModuleType, ...]:
    """Return the readers of fire models, in the order in which they are tried."""
    return tuple(plugins.modules(__name__, "read").values())


def open(path: str | Path) -> Run:
    """Open the run at `path`.

    Raises
    ------
    InputError
        The path is missing, is a fire model's own output, has an unknown format, or is damaged.
    """
    path = Path(path)
    with reading(path):
        if not folder.sniff(path) and foreign(path):
            reason = f"is a fire model's own output; make a run of it: firetwin convert {path} --out RUN"
            raise input_error(path, reason)
        found = folder.open(path) if folder.sniff(path) else opening.open(path)  # which reports errors
        bounds.check_times(found)
        bounds.check_heights(found)
        return found


def foreign(path: Path) -> bool:
    """Check by its first bytes whether a path looks like output of a fire model; nothing is parsed."""
    if _resembles_one(path):
        return True
    inside = path.iterdir() if path.is_dir() and not folder.sniff(path) else ()
    return any(_resembles_one(each) for each in inside if each.is_file())


def _resembles_one(path: Path) -> bool:
    """Check whether a reader is for such files; the generic netCDF reader knows what others would open."""
    return any(getattr(each, "resembles", each.sniff)(path) for each in reversed(models()))


def gathered(paths: list[Path]) -> list[Path]:
    """Collect these files and the files in these folders.

    Raises
    ------
    InputError
        The folders have no files, or far too many.
    """
    files: list[Path] = []
    for path in paths:
        if not path.exists():
            raise input_error(path, "there is no such file or folder; check the path")
        with reading(path):
            inner = (
                [path] if _is_input(path) else [each for each in sorted(path.iterdir()) if _is_input(each)]
            )
        files += [file for file in inner if file not in files]
        if len(files) > _MANY:
            raise input_error(path, f"holds more than {_MANY:,} files; give the files of one run")
    if not files:
        raise input_error(paths[0], "is a folder without files; give the output folder of a model")
    return files


def _is_input(path: Path) -> bool:
    """Check whether an entry of a folder is a file, or a folder that a format takes for one."""
    return path.is_file() or _resembles_one(path)


def reader(paths: list[Path]) -> ModuleType:
    """Select the reader that recognises some of the files; the generic netCDF reader comes last.

    Raises
    ------
    InputError
        No reader recognises them, or they belong to several runs.
    """
    from ..models import one_run, probability_maps

    modules = models()
    broken: list[Error] = []
    by_name: dict[str, list[Path]] = {}
    for path in paths:
        try:
            known = next((module.NAME for module in modules if module.sniff(path)), None)
        except Error as error:  # another file may be readable
            broken.append(error)
            continue
        if known:
            by_name.setdefault(known, []).append(path)
    if len(by_name) > 1:
        by_name.pop(modules[-1].NAME, None)
    if not by_name:
        refused = next(filter(None, map(probability_maps.refusal, paths)), None)
        raise broken[0] if broken else refused or input_error(paths[0], _why(paths))
    one_run.of_models(by_name)
    ((name, ours),) = by_name.items()
    one_run.of_series(ours)
    return next(module for module in modules if name == module.NAME)


def _why(paths: list[Path]) -> str:
    """Give the most likely reason why no reader recognises the files."""
    from ..models import raster

    first, modules = paths[0], models()
    if first.stat().st_size == 0:
        return "is empty; the copy or the model's run was most likely cut short"
    kind = first.suffix.lower()
    if (kind in (".nc", ".tif", ".tiff") and not _resembles_one(first)) or (
        kind == ".npz" and not zipfile.is_zipfile(first)
    ):
        return f"does not begin as a {first.suffix} file does; it is damaged or something else"
    if said := next(filter(None, (each.why(paths) for each in modules if hasattr(each, "why"))), ""):
        return said
    if raster.is_raster(first):
        named = ", ".join(each.RASTER for each in modules if hasattr(each, "RASTER"))
        return f"rasters are identified by name: name arrival times {named}"
    known = ", ".join(filter(None, (getattr(each, "MODELS", each.NAME) for each in modules)))
    return f"is output of no known fire model: {known}"
