"""Kinds of run folders and files: each module in this package is one, found by what is in it.

A module says ``NAME``, what people call the format; ``sniff(path) -> bool``, whether this is one, from its
content; and ``open(path) -> Run``.
"""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path
from types import ModuleType

from firetwin_core import run
from firetwin_core.run import Run


def open(path: str | Path) -> Run:
    """The run at `path`, whatever its format.

    Raises
    ------
    InputError
        There is nothing, it is of no known format, or it is damaged.
    """
    path = Path(path)
    reader = next((reader for reader in known() if reader.sniff(path)), None)
    return reader.open(path) if reader else run.open(path)  # which says what is wrong


def known() -> list[ModuleType]:
    """All readers, in the order of their files' names."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return [importlib.import_module(f".{name}", __name__) for name in names]
