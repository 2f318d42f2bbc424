"""Work for worker processes in tests. `importable` lets them import this module."""

import os
import re
import stat
from pathlib import Path

from firetwin.errors import Error, TryAgainError, UnavailableError, full_disk_error, input_error


def importable(monkeypatch):
    """Put this folder on the path of worker processes."""
    path = [str(Path(__file__).parent), os.environ.get("PYTHONPATH")]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, path)))


def arenas(progress, tell):
    """Return the number of glibc's arenas."""
    return os.environ["MALLOC_ARENA_MAX"]


def kind_of_stdin(progress, tell):
    """Return the kind of file that libraries meet as stdin."""
    return stat.S_IFMT(os.fstat(0).st_mode)


def folder_of_blender(progress, tell):
    """Return the folder of Blender's temporary files."""
    import bpy

    return bpy.app.tempdir


def number(progress, tell):
    """Return the number of the process."""
    return os.getpid()


def report(progress, tell):
    """Report progress with a note, and a message."""
    progress(1, 2, "rendering", "a.png")
    tell("half")
    progress(2, 2)


def remove_logs(folder, progress, tell):
    """Remove the logs of worker processes."""
    for log in folder.glob("firetwin-*.log"):
        log.unlink()
    return 7


def abort(*_, **__):
    """Crash."""
    os.abort()


def allocate(*_, **__):
    """Take 1 GB of memory."""
    bytearray(1 << 30)


def open_missing(*_, **__):
    """Write a file in a folder that does not exist."""
    Path("/nowhere/at_all").write_text("")


def hang(*_, **__):
    """Stay in C with Python held, for longer than the Sun burns."""
    re.match("(a+)+$", "a" * 60 + "b")


def report_and_hang(progress, tell):
    """Report progress, and then hang."""
    progress(1, 2)
    hang()


def send_back(value, progress, tell):
    """Write to stdout as libraries do, in Python and in C, and return the value."""
    print("noise")
    os.write(1, b"noise\n")
    return value


def fail(fault, progress, tell):
    """Raise the error of a fault."""
    raise {
        "full": full_disk_error("a.png"),
        "room": OSError(28, "No space left on device", "b.png"),
        "nameless": OSError(28, "No space left on device"),
        "other": OSError(5, "Input/output error", "c.png"),
        "device": TryAgainError("no GPU"),
        "asked": input_error("scene.toml", "no GPU", line=3, column=4, kind=UnavailableError),
        "wrong": input_error("scene.toml", "the disk is full, says a name", line=3, column=4),
        "plain": Error("stopped"),
        "bug": ValueError("odd"),
    }[fault]
