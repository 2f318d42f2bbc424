"""Converter job of ensembles: gathers runs, or reads a model's members, in a process that may crash."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import input_error, reading
from ..jobs import convert, worker
from ..progress import MessageCallback, Progress, no_message, silent

if TYPE_CHECKING:
    from ..run.models.model import Options


def run(
    paths: list[Path],
    out: Path,
    start: str = "",
    at: str = "",
    projection: str = "",
    horizon: float = 0.0,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    name: str = "",
    zone: str = "",
) -> Path:
    """Convert the members of a forecast to an ensemble in the folder `out`, and return that folder.

    Parameters
    ----------
    paths
        A folder of run folders, a list of runs (``ensemble.toml``), or the files and folders of a model.
    horizon
        Length of the forecast, s; 0: from the files.

    Raises
    ------
    InputError, Error, UsageError, StoppedError
        As `jobs.convert.run`.
    """
    from ..run.models import write
    from ..run.models.model import Options

    for path in paths:
        if not path.exists():
            raise input_error(path, "there is no such file or folder; check the path")
    options = Options.of(start, at, projection, 0.0, [], name, zone)
    write.check(out)
    work = partial(in_process, [path.absolute() for path in paths], out.absolute(), options, horizon)
    convert.work_apart(work, paths[0], progress, tell, stop)
    return out


def in_process(
    files: list[Path],
    out: Path,
    options: Options,
    horizon: float = 0.0,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
) -> None:
    """Worker side: gather runs, or select the reader, read and write."""
    from .ensemble import gather, member_set, readers

    with reading(files[0]):
        if len(files) == 1 and gather.sniff(files[0]):
            manifest, notes = gather.convert(files[0], out, horizon, tell), []
        else:
            members = readers.read(files, options, horizon)
            manifest, notes = member_set.save(members, out, files[0]), members.notes
    total, issued = len(manifest.members) + len(manifest.left_out), ""
    if manifest.issued:
        issued = f" after {manifest.issued:%Y-%m-%d %H:%M} UTC"
    tell(f"{len(manifest.members)} of {total} members, up to {manifest.horizon / 3600.0:.4g} h{issued}")
    for each in manifest.left_out:
        tell(f"left out: {each.name}: {each.reason}")
    for text in filter(None, notes):
        tell(text)
