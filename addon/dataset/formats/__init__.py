"""Formats of data sets: modules with `write(set_folder, samples, out)`, and the fields of their `Format`.

`set_folder` has the files of the samples, and `out` is an empty folder, whose content moves to `set_folder`
after all of it is written (see `staging`). So paths in its files are relative to `set_folder`.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ... import plugins
from ...errors import UsageError
from ...staging import staging

if TYPE_CHECKING:
    from ..truth import Truth

    Writer = Callable[[Path, Sequence[Truth], Path], None]


@dataclass(frozen=True)
class Format:
    """A format of data sets.

    Attributes
    ----------
    help
        Content and place of the files, in one line.
    package
        Package that the format needs; "" if it needs none.
    """

    help: str
    package: str = ""


FORMATS = {name: Format(**each) for name, each in plugins.declared(Path(__file__).parent, "FORMAT").items()}


def names(text: str) -> tuple[str, ...]:
    """Split a list of formats such as ``coco,yolo``; "all" stands for each that this installation can write.

    Raises
    ------
    UsageError
        A format is unknown, or its package is missing or does not load.
    """
    if text == "all":
        return tuple(name for name in FORMATS if not _fault(name))
    found = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    for name in found:
        if name not in FORMATS:
            raise UsageError(f'there is no format "{name}"; choose from {", ".join(FORMATS)}, all')
        if fault := _fault(name):
            raise UsageError(fault)
    return found


def writer(name: str) -> Writer:
    """Return the function that writes a format."""
    return plugins.module(__name__, name).write


def write(set_folder: Path, samples: Sequence[Truth], formats: Iterable[str]) -> None:
    """Write the labels of the samples in each format; files of a format appear when it is complete.

    Raises
    ------
    InputError
        The disk is full, or a file of a sample is missing or damaged.
    """
    for name in formats:
        with staging(set_folder) as out:
            writer(name)(set_folder, samples, out)


def _fault(name: str) -> str:
    """Return why a format cannot be written: its package is missing, or needs another NumPy. "" if it can."""
    package = FORMATS[name].package
    try:
        if package:
            importlib.import_module(package)
    except ModuleNotFoundError:
        return f"the format {name} needs {package}; install it with: pip install {package}"
    except ImportError as error:
        return f"the format {name} needs {package}, which does not load: {error}; install another version"
    return ""
