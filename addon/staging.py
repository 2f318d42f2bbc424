"""Atomic writes of several files and of folders: they get their names after all content is complete."""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError, input_error, writing


@contextmanager
def staging(out: Path) -> Iterator[Path]:
    """Make a temporary folder next to `out`; without an error its files and folders then move to `out`.

    A file or folder of the same name in `out` is replaced. A killed process leaves `out` as it was, and the
    temporary folder, whose name ends in ``.part``.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    out = out.absolute()
    part = _part(out)
    try:
        with _temporary(part, out):
            yield part
            _sync(part)
            out.mkdir(exist_ok=True)
            for made in sorted(part.iterdir()):
                _replace(made, out / made.name, part)
    except InputError as error:
        path = Path(error.path)
        if not path.is_relative_to(part):
            raise
        raise input_error(out / path.relative_to(part), error.reason, kind=type(error)) from error


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Make a temporary folder next to `path`; without an error it gets this name, which must be free.

    Raises
    ------
    InputError
        The disk is full, the folder cannot be written, or the name is not free.
    """
    part = _part(path)
    with _temporary(part, path):
        yield part
        part.rename(path)


def _part(path: Path) -> Path:
    return path.with_name(f".{path.name}.{uuid.uuid4().hex[:12]}.part")


@contextmanager
def _temporary(part: Path, path: Path) -> Iterator[None]:
    """Make a folder and remove it at the end; errors name `path`."""
    try:
        with writing(path):
            part.mkdir(parents=True)
            yield
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _replace(made: Path, path: Path, part: Path) -> None:
    """Rename a finished file or folder; an old folder goes to the temporary folder first."""
    if path.is_dir() and not path.is_symlink():
        path.rename(part / f"{made.name}.{uuid.uuid4().hex[:12]}.old")
    made.replace(path)


def _sync(folder: Path) -> None:
    """Wait until the content of all files is on the disk."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            with path.open("r+b") as file:  # Windows cannot flush through a read-only handle
                os.fsync(file.fileno())
