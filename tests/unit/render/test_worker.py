"""Worker processes on disks that are full or read-only."""

import errno
import tempfile
from pathlib import Path

import pytest
from firetwin.errors import FullDiskError, InputError
from firetwin.jobs import worker


@pytest.mark.parametrize(("code", "kind"), [(errno.ENOSPC, FullDiskError), (errno.EROFS, InputError)])
def test_a_log_that_cannot_be_written_is_one_line(monkeypatch, code, kind):
    def fail(**_):
        raise OSError(code, "no")

    monkeypatch.setattr(tempfile, "NamedTemporaryFile", fail)
    with pytest.raises(kind, match="the temporary folder: "):
        worker.run("a:b", {})


def test_a_log_stays_on_a_disk_that_became_read_only(monkeypatch, tmp_path):
    def fail(*_, **__):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(Path, "unlink", fail)
    worker._remove(tmp_path / "log")
