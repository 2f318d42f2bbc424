"""One process at a time does a piece of work; the others wait until it is done, or take it over. No Blender.

Who works holds a lock of the operating system on an empty file; it ends with the process, however that ends.
Where a file system knows no locks, everybody works: they do the same twice.
"""

from __future__ import annotations

import contextlib
import errno
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from ...errors import writing

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None
    import msvcrt

_LOOK = 0.5  # s between two looks of who waits
_BUSY = (errno.EWOULDBLOCK, errno.EACCES, errno.EDEADLK)


@contextlib.contextmanager
def held(path: Path, done: Callable[[], bool], wait: Callable[[], None]) -> Iterator[bool]:
    """Hold the file `path`; False, and not held, if the work turns out done while another has it.

    Parameters
    ----------
    wait
        Called now and then while another works; what it raises ends the waiting.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    with writing(path):
        file = os.open(path, os.O_CREAT | os.O_RDWR)
    try:
        mine = _lock(file)
        while not mine and not done():
            wait()
            time.sleep(_LOOK)
            mine = _lock(file)
        yield mine
    finally:
        os.close(file)


def _lock(file: int) -> bool:
    """Whether a file is ours now."""
    try:
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        else:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
    except OSError as error:
        return error.errno not in _BUSY
    return True
