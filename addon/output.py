"""Files that commands write for their user: all doors to the user's folders follow one rule.

A file that Firetwin wrote and nobody changed since (see `written`) is replaced. A file of others, a changed
file and a link are refused, and replaced only at the user's request (``--overwrite``). Write-protected files,
folders and devices are never replaced. No file is written into the folder of a run.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path

from . import files, unfinished, written
from .errors import input_error, writing

REMEDY = "choose another name, or add --overwrite"
_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH
_RUN = "run.toml"


def is_plain_name(text: str) -> bool:
    """Check whether a text that was read from a file can be the name of a file or folder on all systems."""
    return text not in ("", ".", "..") and not any(ord(each) < 32 or each in '/\\:*?"<>|' for each in text)


def check(path: Path, overwrite: bool = False, root: Path | None = None) -> None:
    """Check that a file may be written at `path`; commands call it before their work.

    Parameters
    ----------
    overwrite
        Replace files of others, changed files and links.
    root
        Folder whose record lists the file, and which was checked itself; its own folder by default.

    Raises
    ------
    InputError
        It may not.
    """
    if root is None:
        refuse_run_folders(path)
    try:
        mode = path.lstat().st_mode
    except OSError:
        return  # a folder that cannot be read is reported by the write
    if reason := _never(mode):
        raise input_error(path, reason)
    if overwrite:
        return
    if stat.S_ISLNK(mode):
        raise input_error(path, f"is a link, which is not followed; {REMEDY}")
    if reason := _foreign(path, root or path.parent):
        raise input_error(path, f"{reason}; {REMEDY}")


def write(path: Path, put: Callable[[Path], object], overwrite: bool = False) -> None:
    """Write a file by the rule, atomically: ``put(part)`` writes it in a temporary folder.

    Raises
    ------
    InputError
        `path` may not be replaced, the disk is full, or the folder cannot be written.
    """
    check(path, overwrite)
    with unfinished.folder(path) as folder:
        put(folder / path.name)
        publish(folder / path.name, path, overwrite)


def write_text(path: Path, text: str, overwrite: bool = False) -> None:
    """Write a text by the rule, as UTF-8, with the same line ends on all systems (see `write`)."""
    write(path, lambda part: part.write_text(text, encoding="utf-8", newline="\n"), overwrite)


def publish(part: Path, path: Path, overwrite: bool = False) -> None:
    """Record a finished temporary file in the folder of `path`, and give it this name by the rule."""
    check(path, overwrite)
    with writing(path):
        written.add(path.parent, {path.name: written.digest(part)})
    files.publish(part, path)


def is_own(path: Path, root: Path | None = None) -> bool:
    """Check whether a file is Firetwin's and unchanged."""
    try:
        regular = stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False
    return regular and not _foreign(path, root or path.parent)


def publish_blend(part: Path, path: Path) -> Path | None:
    """Give a finished .blend file its name; rename a file of others to ``.blend1`` first, as Blender does.

    Returns
    -------
    The renamed file; None if there was none.

    Raises
    ------
    InputError
        The file may not be replaced.
    """
    check_blend(path)
    kept = None
    if os.path.lexists(path) and not is_own(path):
        kept = path.with_name(f"{path.name}1")
        with writing(kept):
            path.replace(kept)
    publish(part, path)
    return kept


def check_blend(path: Path) -> None:
    """Check that a .blend file may be written at `path` (see `publish_blend`).

    Raises
    ------
    InputError
        It may not.
    """
    check(path, overwrite=True)
    check(path.with_name(f"{path.name}1"), overwrite=True)


def refuse_run_folders(path: Path) -> None:
    """Refuse a path within the folder of a run, whose files are inputs.

    Raises
    ------
    InputError
        It is in one.
    """
    for folder in path.absolute().parents:
        if (folder / _RUN).is_file():
            raise input_error(path, f"is in the folder of a run, {folder}; choose another folder")


def _never(mode: int) -> str:
    """Return why a file of this mode is never replaced; "" if it may be."""
    if stat.S_ISDIR(mode):
        return "is a folder; name a file"
    if not stat.S_ISLNK(mode) and not stat.S_ISREG(mode):
        return "is a device or a pipe; name a file"
    if not stat.S_ISLNK(mode) and not mode & _WRITABLE:
        return "is write-protected; choose another name"
    return ""


def _foreign(path: Path, root: Path) -> str:
    """Return why a regular file is not Firetwin's as it is now; "" if it is."""
    known = written.read(root).get(path.relative_to(root).as_posix())
    if not known:
        return "exists already, and Firetwin did not write it"
    try:
        same = written.digest(path) in known
    except OSError:
        return "exists already and cannot be read"
    return "" if same else "has changed since Firetwin wrote it"
