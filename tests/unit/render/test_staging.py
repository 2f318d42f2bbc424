"""Files of a folder appear complete, or not at all."""

import errno

import pytest
from firetwin.errors import FullDiskError, InputError
from firetwin.staging import new_folder, staging


def fill(folder, text):
    (folder / "smoke").mkdir()
    (folder / "smoke" / "000001.vdb").write_text(text)
    (folder / "scene.usda").write_text(text)


def fail(out):
    with staging(out) as folder:
        fill(folder, "new")
        raise OSError(errno.ENOSPC, "No space left on device")


def collide(out):
    with new_folder(out) as folder:
        fill(folder, "new")
        out.mkdir()
        (out / "mine.txt").write_text("mine")


def content(folder):
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def test_new_files_replace_old_ones_and_others_stay(tmp_path):
    out = tmp_path / "more" / "out"
    with staging(out) as folder:
        fill(folder, "old")
        (folder / "smoke" / "000002.vdb").write_text("old")
    (out / "mine.txt").write_text("mine")
    with staging(out) as folder:
        assert folder.parent == out.parent
        fill(folder, "new")
    assert content(out) == {"mine.txt": "mine", "scene.usda": "new", "smoke/000001.vdb": "new"}
    assert list(out.parent.iterdir()) == [out]


def test_an_error_leaves_the_folder_as_it_was(tmp_path):
    out = tmp_path / "out"
    with staging(out) as folder:
        fill(folder, "old")
    before = content(out)
    for path in (out, tmp_path / "absent"):
        with pytest.raises(FullDiskError, match="the disk is full"):
            fail(path)
    assert content(out) == before
    assert list(tmp_path.iterdir()) == [out]


def test_a_new_folder_never_replaces_one_that_came_meanwhile(tmp_path):
    out = tmp_path / "out"
    with pytest.raises(InputError, match="out: cannot be written"):
        collide(out)
    assert content(tmp_path) == {"out/mine.txt": "mine"}
