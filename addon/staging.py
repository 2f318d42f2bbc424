"""Atomic writes of several files and of folders: they get their names after all content is complete.

Files are replaced one by one, by the rule of `output`; no folder is removed with its content, and no link is
followed.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from . import files, output, unfinished, written
from .errors import InputError, input_error


@contextmanager
def staging(out: Path, overwrite: bool = False, is_run: bool = False) -> Iterator[Path]:
    """Make a temporary folder next to `out`; without an error its files then move to `out`.

    Files of an earlier call that the new content lacks are removed from the folders that it has, unless they
    were changed. A killed process leaves `out` as it was.

    Parameters
    ----------
    overwrite
        Replace files of others, changed files and links.
    is_run
        `out` is a run folder, whose files all belong to the set.

    Raises
    ------
    InputError
        A file may not be replaced (see `output.check`), the disk is full, or the folder cannot be written.
    """
    out = out.absolute()
    output.refuse_run_folders(out if is_run else out / "file")
    part = out
    try:
        with unfinished.folder(out) as part:
            yield part
            _sync(part)
            _move(part, out, overwrite, is_run)
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
    with unfinished.folder(path) as part:
        yield part
        part.rename(path)


def _move(part: Path, out: Path, overwrite: bool, whole: bool) -> None:
    """Move all files to `out` after all are checked, and remove those that they replace as a set.

    Parameters
    ----------
    whole
        The set is all of `out`, and not only the folders that the new files have.
    """
    names = _names(part)
    for name in names:
        _check_folders(out, name)
        output.check(out / name, overwrite, root=out)
    out.mkdir(exist_ok=True)
    before = written.read(out)
    written.add(out, {name: written.digest(part / name) for name in names})
    for folder in (each for each in sorted(part.rglob("*")) if each.is_dir()):
        (out / folder.relative_to(part)).mkdir(exist_ok=True)
    for name in names:
        files.replace(part / name, out / name)
    folders = {name.split("/")[0] for name in names if "/" in name}
    for name in sorted(before.keys() - set(names), reverse=True):
        if whole or name.split("/")[0] in folders:
            _remove(out, name)


def _names(folder: Path) -> list[str]:
    """List the paths of all files relative to a folder, sorted."""
    found = (path for path in folder.rglob("*") if not path.is_dir() or path.is_symlink())
    return sorted(path.relative_to(folder).as_posix() for path in found)


def _check_folders(out: Path, name: str) -> None:
    """Check that the folders between `out` and a file are folders or missing, not links.

    Raises
    ------
    InputError
        One is another file.
    """
    for parent in [*(out / name).parents][: name.count("/")][::-1]:
        try:
            mode = parent.lstat().st_mode
        except OSError:
            return
        if stat.S_ISLNK(mode):
            raise input_error(parent, "is a link, which is not followed; choose another folder")
        if not stat.S_ISDIR(mode):
            raise input_error(parent, "is a file; choose another folder")


def _remove(out: Path, name: str) -> None:
    """Remove a file of an earlier call if it is unchanged, and its folders if they are then empty."""
    path = out / name
    if ".." in path.parts or not path.is_relative_to(out):
        return
    with contextlib.suppress(OSError, InputError):
        _check_folders(out, name)
        if output.is_own(path, out):
            path.unlink()
            for parent in [*path.parents][: name.count("/")]:
                parent.rmdir()


def _sync(folder: Path) -> None:
    """Wait until the content of all files is on the disk."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            with path.open("r+b") as file:  # Windows cannot flush through a read-only handle
                os.fsync(file.fileno())
