"""Fire models' own files made into a run, in a process of its own, which a damaged file may end."""

from __future__ import annotations

import hashlib
from pathlib import Path

from ..errors import Error, UsageError
from ..progress import Progress, Tell, silent, untold
from . import worker

PATIENCE = 600.0
"""s without a part of a file read or written after which a conversion is ended.

A damaged HDF5 file can keep its library busy for ever. A part has 2 GB at most, mostly one field at one time,
so that a disk of 4 MB/s is waited for, however large the files are.
"""


def run(
    paths: list[Path],
    out: Path,
    start: str = "",
    at: str = "",
    projection: str = "",
    interval: float = 0.0,
    progress: Progress = silent,
    tell: Tell = untold,
    stop: worker.Stop | None = None,
) -> Path:
    """Write the run that these files and folders hold to the folder `out`, and return that.

    What was made before a stop is gone on with. `start`, `at`, `projection` and `interval` are the command
    line's.

    Raises
    ------
    InputError, Error
        One line that says what is wrong; nothing that could be taken for a run is there then.
    UsageError
        An option makes no sense.
    StoppedError
        `stop` was used.
    """
    from ..run.models import write
    from ..run.models.model import Options
    from ..run.readers import gathered

    files = gathered(paths)
    Options.of(start, at, projection, interval, files)
    write.check(out)
    task = {
        "paths": [str(path.absolute()) for path in files],
        "out": str(out.absolute()),
        "options": [start, at, projection, interval],
    }
    try:
        worker.run(
            f"{__name__}:in_process", task, progress, stop=stop, tell=tell, blender=False, patience=PATIENCE
        )
    except worker.EndedError as error:
        raise Error(f"{paths[0]}: reading it {error}; the file is most likely damaged") from None
    return out


def in_process(
    paths: list[str], out: str, options: list, progress: Progress = silent, tell: Tell = untold
) -> None:
    """The child's side: find the reader, read and write."""
    from ..run.models import headway

    files = [Path(path) for path in paths]
    with headway.to(lambda: worker.sign()):
        _convert(files, Path(out), options, progress, tell)


def _convert(files: list[Path], out: Path, options: list, progress: Progress, tell: Tell) -> None:
    from ..run import readers
    from ..run.models import write
    from ..run.models.model import Options

    try:
        said = Options.of(*options, files)
        reader = readers.reader(files)
        tell(f"{files[0].name} is {reader.NAME}")
        model = reader.read(files, said)
        try:
            write.write(model, out, _fingerprint(files, options), progress)
        finally:
            model.close()
        placed = (("grid", model.grid.placed), ("fuel grid", model.fuel_grid.placed))
        moved = [f"{name}: {each.error}" for name, each in placed if each.error]
        for text in [*model.assumptions, *moved]:
            tell(text)
    except (Error, UsageError, OSError):
        raise
    except MemoryError:
        raise Error(f"{files[0]}: memory ran out; it is damaged, or its grid is too large") from None
    except Exception as error:
        why = " ".join(f"{type(error).__name__}: {error}".split())
        raise Error(f"{files[0]}: what it holds makes no sense; it is damaged ({why})") from error


def _fingerprint(files: list[Path], options: list) -> str:
    """Changes when the files, or what is said of them, do."""
    stamps = [(str(path), path.stat().st_size, path.stat().st_mtime_ns) for path in files]
    return hashlib.sha256(repr((stamps, options)).encode()).hexdigest()
