"""The asset library: its content, and that Blender lists it as assets."""

import contextlib

import pytest
from firetwin.errors import InputError
from firetwin.jobs import assets as job
from firetwin.jobs import build


def test_the_catalogue_is_one_that_blender_reads():
    lines = [line for line in job.catalogue().splitlines() if line and not line.startswith("#")]
    assert lines[0] == "VERSION 1"
    assert [line.split(":")[0] for line in lines[1:]] == [
        job.identifier(name) for name in ("Firetwin", *job.CATALOGUES)
    ]
    assert all(len(line.split(":")) == 3 for line in lines[1:])


def test_a_library_of_somebody_else_stays(tmp_path):
    theirs = tmp_path / job.CATALOGUE
    theirs.write_text("VERSION 1\n")
    with pytest.raises(InputError, match="belongs to another asset library"):
        job.run(None, tmp_path)
    assert theirs.read_text() == "VERSION 1\n"


@pytest.mark.parametrize(("full", "words"), [(True, "the disk is full"), (False, "cannot be written")])
def test_a_file_that_cannot_be_saved_is_one_clear_error(tmp_path, monkeypatch, full, words):
    monkeypatch.setattr(build, "is_nearly_full", lambda path: full)
    monkeypatch.setattr(build.unfinished, "folder", lambda path: contextlib.nullcontext(tmp_path / "gone"))
    with pytest.raises(InputError, match=rf"away.{job.BLEND}: {words}"):
        build.save(tmp_path / "away" / job.BLEND, print)
