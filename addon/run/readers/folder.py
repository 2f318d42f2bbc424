"""Reader of Firetwin's own format: a folder with run.toml, and a file or a folder of files per field.

A feature's ``run_folder.py`` recognises other folders that stand for a run, such as one that still grows. It
has ``sniff(path)``, ``newest(path)``, the run folder to read, ``changing_file(path)``, and
``warning(run, zone)``, a warning about a run with its head, or ("", "").
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from firetwin_core.run import Run

from ... import plugins
from .. import opening

NAME = "a folder with run.toml"


def sniff(path: Path) -> bool:
    """Check whether the folder contains a run.toml, or stands for a run."""
    return (path / "run.toml").is_file() or _reader(path) is not None


def changing_file(path: Path) -> Path:
    """Return the file of a run that changes with the run."""
    reader = _reader(path)
    return reader.changing_file(path) if reader else path / "run.toml"


def open(path: Path) -> Run:
    """Open the run."""
    reader = _reader(path)
    return opening.open(reader.newest(path) if reader else path)


def warnings(path: Path, zone: str) -> list[tuple[str, str]]:
    """Return heads and texts of warnings about the run in a folder."""
    return [found for each in plugins.of_features("run_folder") if any(found := each.warning(path, zone))]


def _reader(path: Path) -> ModuleType | None:
    if (path / "run.toml").is_file():
        return None
    return next((each for each in plugins.of_features("run_folder") if each.sniff(path)), None)
