"""Files of a folder appear complete, or not at all."""

import errno

import pytest
from firetwin import written
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


def replace(out, **how):
    with staging(out, **how) as folder:
        fill(folder, "new")


def content(folder):
    paths = (path for path in folder.rglob("*") if path.is_file() and path.name != written.NAME)
    return {path.relative_to(folder).as_posix(): path.read_text() for path in paths}


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


def test_a_folder_of_the_user_stays_with_its_files(tmp_path):
    out = tmp_path / "out"
    (out / "smoke").mkdir(parents=True)
    (out / "smoke" / "mine.vdb").write_text("mine")
    (out / "scene.usda").write_text("mine")
    with pytest.raises(InputError, match=r"scene\.usda: exists already, and Firetwin did not write it"):
        replace(out)
    assert content(out) == {"smoke/mine.vdb": "mine", "scene.usda": "mine"}
    replace(out, overwrite=True)
    assert content(out) == {"smoke/mine.vdb": "mine", "scene.usda": "new", "smoke/000001.vdb": "new"}


def test_a_folder_that_is_a_link_is_not_followed(tmp_path):
    out, there = tmp_path / "out", tmp_path / "there"
    out.mkdir()
    there.mkdir()
    (out / "smoke").symlink_to(there)
    with pytest.raises(InputError, match="smoke: is a link"):
        replace(out, overwrite=True)
    assert list(there.iterdir()) == []


def test_rests_of_a_killed_process_are_removed_and_those_in_use_stay(tmp_path):
    out, rest = tmp_path / "out", tmp_path / ".out.0123456789ab.part"
    rest.mkdir()
    (rest / "smoke.vdb").write_text("rest")
    (tmp_path / ".out.mine.part").mkdir()
    with staging(out) as folder:
        fill(folder, "one")
        with staging(out) as second:
            fill(second, "two")
        assert folder.is_dir()
    assert not rest.exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == [".out.mine.part", "out"]


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
