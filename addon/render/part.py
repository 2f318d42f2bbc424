"""A place for files in the making."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def part_folder(out: Path) -> Iterator[Path]:
    """A folder inside `out`, so that finished files can be renamed; those that killed processes left go."""
    out.mkdir(parents=True, exist_ok=True)
    sweep(out)
    part = out / f".part-{os.getpid()}"
    part.mkdir(exist_ok=True)
    try:
        yield part
    finally:
        shutil.rmtree(part, ignore_errors=True)


def sweep(out: Path) -> None:
    """Remove what processes that are no more have left unfinished."""
    for left in out.glob(".part-*"):
        if not _alive(left.name.removeprefix(".part-")):
            shutil.rmtree(left, ignore_errors=True)


def _alive(process: str) -> bool:
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, ValueError):
        return False
    except OSError:
        return True
    return True
