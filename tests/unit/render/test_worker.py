"""Worker processes: their pipe, and disks that are full or read-only."""

import errno
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
