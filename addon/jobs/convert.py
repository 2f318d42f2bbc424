"""Converter job: converts a fire model's files into a run, in a process that a damaged file may crash."""

from __future__ import annotations

import hashlib
import itertools
import os
import tomllib
from functools import partial
from pathlib import Path

from .. import files
from ..errors import Error, InputError, reading
from ..limits import SETTINGS_BYTES
from ..progress import MessageCallback, Progress, no_message, silent
from . import worker

PATIENCE = 600.0
"""Timeout, s without progress in reading or writing, after which a conversion is ended.

A damaged HDF5 file can put its library into an endless loop. A read or write has 2 GB at most, mostly one
field at one time, so a disk of 4 MB/s is fast enough for files of any size.
"""


def run(
    paths: list[Path],
    out: Path,
    start: str = "",
    at: str = "",
    projection: str = "",
    interval: float = 0.0,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    name: str = "",
    zone: str = "",
    member: str = "",
    wind: list[Path] | None = None,
) -> Path:
    """Convert these files and folders to a run in the folder `out`, and return that folder.

    A conversion that was stopped is resumed. `start`, `at`, `projection`, `interval`, `name`, `zone`,
    `member` and `wind` are the options of the command line.

    Raises
    ------
    InputError, Error
        The files cannot be converted; no folder that could be taken for a run is left.
    UsageError
        An option is invalid.
    StoppedError
        `stop` was used.
    """
    from ..run.models import write
    from ..run.models.model import Options
    from ..run.readers import gathered

    files = paths if member else gathered(paths)
    forecast = [path.absolute() for path in gathered(wind)] if wind else []
    Options.of(start, at, projection, interval, files, name, zone)
    write.check(out)
    options = [start, at, projection, interval, name, zone]
    work = partial(
        in_process, [path.absolute() for path in files], out.absolute(), options, member=member, wind=forecast
    )
    work_apart(work, paths[0], progress, tell, stop)
    return out


def work_apart(
    work: worker.Work[None], path: Path, progress: Progress, tell: MessageCallback, stop: worker.Stop | None
) -> None:
    """Work in a worker process that a damaged file may crash.

    Raises
    ------
    Error
        The process ended in another way than by an error: the file at `path` is most likely damaged.
    """
    try:
        worker.run(work, progress, stop=stop, tell=tell, blender=False, patience=PATIENCE)
    except worker.EndedError as error:
        raise Error(f"{path}: reading it {error}; the file is most likely damaged") from None


def default_output(
    paths: list[Path], folders: list[Path], start: str = "", at: str = "", projection: str = ""
) -> tuple[Path, bool]:
    """Choose the default output folder of a conversion; return it, and whether its run exists already.

    It is in the first writable one of the `folders`, named like the input with ``_run`` appended. A run
    converted from other files, or with other options, keeps its folder.

    Raises
    ------
    InputError
        The files are missing.
    Error
        None of the folders can be written to.
    """
    from ..run.readers import gathered

    inputs = _fingerprint([path.absolute() for path in gathered(paths)], [start, at, projection, 0.0, "", ""])
    folder = next((each for each in folders if os.access(_existing(each), os.W_OK)), None)
    if folder is None:
        raise Error(f"{paths[0]}: its folder cannot be written to; choose an output folder first")
    for number in itertools.count(1):
        out = folder / f"{paths[0].stem}_run{f'_{number}' if number > 1 else ''}"
        if not out.exists():
            return out, False
        if _made_of(out) == inputs:
            return out, True
    raise AssertionError  # numbers do not end


def _existing(folder: Path) -> Path:
    return next(each for each in (folder.absolute(), *folder.absolute().parents) if each.exists())


def _made_of(out: Path) -> str:
    try:
        text = files.read_text(out / "run.toml", most=SETTINGS_BYTES)
        return str(tomllib.loads(text)["source"]["inputs"])
    except (OSError, InputError, ValueError, KeyError, TypeError, RecursionError):
        return ""


def in_process(
    files: list[Path],
    out: Path,
    options: list,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    member: str = "",
    wind: list[Path] | None = None,
) -> None:
    """Worker side: select the reader, read and write."""
    from ..run import collections, readers
    from ..run.models import forecast_wind, write
    from ..run.models.model import Options

    start, at, projection, interval, *more = options
    said = Options.of(start, at, projection, interval, files, *more)
    with reading(files[0]):
        if member:
            model = collections.read(files, said, member)
        else:
            reader = readers.reader(files)
            tell(f"{files[0].name} is {reader.NAME}")
            model = reader.read(files, said)
            model.name, model.zone = f"{out.name} ({model.name})", said.zone
        model.name = said.name or model.name
        try:
            if wind:
                forecast_wind.add(model, wind)
            write.write(model, out, _fingerprint([*files, *(wind or [])], options), progress)
        finally:
            model.close()
    for text in [*model.assumptions, *write.moved(model)]:
        tell(text)


def _fingerprint(files: list[Path], options: list) -> str:
    """Hash that changes with the files or the options."""
    every = [each for path in files for each in (sorted(path.rglob("*")) if path.is_dir() else [path])]
    stamps = [(str(path), path.stat().st_size, path.stat().st_mtime_ns) for path in every]
    return hashlib.sha256(repr((stamps, options)).encode()).hexdigest()
