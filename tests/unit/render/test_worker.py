"""Worker processes: their pipe, and disks that are full or read-only."""

import errno
import signal
import stat
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

import child_work
import numpy as np
import pytest
from firetwin.errors import FullDiskError, InputError
from firetwin.geometry.camera_track import CameraTrack
from firetwin.jobs import worker


def test_dataclasses_and_arrays_cross_both_ways_beside_output_of_libraries(monkeypatch):
    """Arrays larger than a pipe's buffer, with bytes of ends of lines."""
    child_work.importable(monkeypatch)
    many = 300_000
    sent = CameraTrack(
        "drone\r\n\x1a",
        np.arange(many),
        np.full((many, 3), 1.5),
        np.full((many, 3, 3), 0.5),
        np.full((many, 2), 0.25),
        36.0,
        "perspective",
        np.full((many, 2), 13.0),
    )
    back = worker.run(partial(child_work.send_back, sent), blender=False)
    assert (type(back), back.name) == (CameraTrack, sent.name)
    np.testing.assert_array_equal(back.frames, sent.frames)
    np.testing.assert_array_equal(back.rotation, sent.rotation)


def test_a_process_does_several_works_until_one_fails(monkeypatch):
    child_work.importable(monkeypatch)
    with worker.Worker(blender=False) as process:
        first, again = (process.run(child_work.number) for _ in range(2))
        with pytest.raises(InputError):
            process.run(child_work.open_missing)
        after = process.run(child_work.number)
        process._child.kill()
        process._child.wait()
        last = process.run(child_work.number)
        child = process._child
    assert first == again
    assert len({first, after, last}) == 3
    assert child.poll() is not None


def test_a_process_of_blender_leaves_no_folder(monkeypatch):
    """Blender removes its folder only when it is shut down, which this process never is."""
    child_work.importable(monkeypatch)
    assert not Path(worker.run(child_work.folder_of_blender)).exists()


@pytest.mark.parametrize(("code", "kind"), [(errno.ENOSPC, FullDiskError), (errno.EROFS, InputError)])
def test_a_log_that_cannot_be_written_is_one_line(monkeypatch, code, kind):
    def fail(**_):
        raise OSError(code, "no")

    monkeypatch.setattr(tempfile, "NamedTemporaryFile", fail)
    with pytest.raises(kind, match="the temporary folder: "):
        worker.run(child_work.abort)


def test_a_log_stays_on_a_disk_that_became_read_only(monkeypatch, tmp_path):
    def fail(*_, **__):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "unlink", fail)
    worker._remove(tmp_path / "log")


def test_libraries_do_not_meet_the_pipe_of_calls(monkeypatch):
    """A library that Windows loads asks for the kind of stdin, and would wait for the end of a read."""
    child_work.importable(monkeypatch)
    assert worker.run(child_work.kind_of_stdin, blender=False) != stat.S_IFIFO


def test_ctrl_break_of_windows_ends_as_sigterm_does(monkeypatch):
    monkeypatch.setattr(signal, "SIGBREAK", signal.SIGINT, raising=False)
    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGINT)}
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        worker.end_on_sigterm()
        with pytest.raises(SystemExit) as ended:
            signal.raise_signal(signal.SIGINT)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    assert ended.value.code == 128 + signal.SIGINT


def test_ctrl_c_does_not_wait_for_an_answer(monkeypatch):
    child_work.importable(monkeypatch)
    code = """
import child_work, os, signal, threading
from firetwin.jobs import worker

def progress(*_):  # all processes of the console get it, as from the keyboard
    for seconds in (0.5, 30.0):  # Python loses a signal that comes just before a read
        again = threading.Timer(seconds, os.kill, (0, getattr(signal, "CTRL_C_EVENT", signal.SIGINT)))
        again.daemon = True
        again.start()

worker.run(child_work.report_and_hang, progress, blender=False)
"""
    console = getattr(subprocess, "CREATE_NEW_CONSOLE", 0)
    options = {"start_new_session": not console, "creationflags": console, "timeout": 120}
    done = subprocess.run([sys.executable, "-c", code], stderr=subprocess.PIPE, **options)
    assert b"KeyboardInterrupt" in done.stderr
