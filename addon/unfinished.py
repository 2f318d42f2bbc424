"""Temporary folders of results that are not finished: locked while in use, and removed after a kill.

A file or folder is written into a hidden folder next to it, ``.NAME.<12 hexadecimal digits>.part``, and then
renamed. A killed process leaves the folder without its lock; the next call for the same name removes it.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import writing

if sys.platform == "win32":
    import _winapi

    _ADD_FILE, _SHARE_READ_DELETE, _OPEN_FOLDERS = 0x2, 0x1 | 0x4, 0x02000000  # of CreateFileW
    _WAIT = 0.05  # s
    _unlock = _winapi.CloseHandle

    def _lock(folder: Path, wait: bool) -> int | None:
        """Open a folder to add files, as which nobody else can then open it; it can be listed and renamed."""
        while True:
            try:
                return _winapi.CreateFile(
                    str(folder), _ADD_FILE, _SHARE_READ_DELETE, 0, _winapi.OPEN_EXISTING, _OPEN_FOLDERS, 0
                )
            except FileNotFoundError:
                raise
            except OSError:
                if not wait:
                    return None
                time.sleep(_WAIT)

else:
    import fcntl

    _unlock = os.close

    def _lock(folder: Path, wait: bool) -> int | None:
        handle = os.open(folder, os.O_RDONLY)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        except OSError:  # also file systems without locks
            os.close(handle)
            return None
        return handle


@contextmanager
def folder(path: Path) -> Iterator[Path]:
    """Make a locked folder for the new content of `path`, a file or a folder, and remove it at the end.

    Raises
    ------
    InputError
        The disk is full, or the folder of `path` cannot be written.
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex[:12]}.part")
    rests(path.parent, re.escape(path.name))
    try:
        with writing(path), contextlib.ExitStack() as life:
            while not part.is_dir():  # `rests` of another process may remove it before it is locked
                life.close()
                part.mkdir(parents=True)
                with contextlib.suppress(FileNotFoundError):
                    life.enter_context(locked(part, wait=True))
            yield part
    finally:
        shutil.rmtree(part, ignore_errors=True)


def rests(folder: Path, pattern: str) -> list[str]:
    """Remove temporary folders in a folder that killed processes left; return names of those in use.

    Parameters
    ----------
    pattern
        Regular expression of the names that their content would get.
    """
    in_use = []
    with contextlib.suppress(OSError):
        for name in os.listdir(folder):  # faster than iterdir, for folders of many files
            part = name.endswith(".part") and re.fullmatch(rf"\.({pattern})\.[0-9a-f]{{12}}\.part", name)
            if part and (each := folder / name).is_dir() and not each.is_symlink():
                with locked(each) as is_alone:
                    if is_alone:
                        shutil.rmtree(each, ignore_errors=True)
                    else:
                        in_use.append(part[1])
    return in_use


@contextmanager
def locked(folder: Path, wait: bool = False) -> Iterator[bool]:
    """Lock a folder until the end of the block or of the process; False if another process has it."""
    handle = _lock(folder, wait)
    try:
        yield handle is not None
    finally:
        if handle is not None:
            _unlock(handle)
