"""All commands that write files for their user follow one rule (see `firetwin.output`); no file is lost.

``python tests/unit/project/test_doors.py`` prints a table of the commands and of Blender's operators.
"""

import os
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "helpers"))
import doors
from firetwin import output, written
from firetwin.errors import InputError
from firetwin.shot.settings import Settings, toml_update

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="forks, and limits the size of files")

EXPECTED = {
    "own": {doors.REPLACED},
    "own, changed": {"refused; --overwrite"},
    "own, changed, --overwrite": {doors.REPLACED},
    "another's file": {"refused; --overwrite"},
    "another's folder": {"refused"},
    "others beside it": {"stays"},
    "link": {"refused; --overwrite"},
    "write-protected": {"refused"},
    "full disk": {"refused"},
    "killed": {doors.REPLACED},
}
BLEND = {
    state: {"kept as .blend1"}
    for state in ("own, changed", "own, changed, --overwrite", "another's file", "link")
}
MARKS = {
    "library/blender_assets.cats.txt",
    "out/heat_flux.npy",
    "out/run.toml",
    "out/terrain/0.glb",
    "out/tileset.json",
    "out/times.json",
}
"""Files of folders that a file in them marks as the command's: without it nothing is written."""
CASES = [(name, path) for name, door in doors.DOORS.items() for path in door.outputs]


def test_every_command_is_a_door_or_known_to_be_none():
    """A new command fails here until `doors` has a call of it."""
    assert doors.DOORS.keys() | doors.NO_DOORS.keys() | doors.FOLDERS.keys() == doors.verbs().keys()
    assert len(doors.DOORS) + len(doors.NO_DOORS) + len(doors.FOLDERS) == len(doors.verbs())


def test_every_door_has_the_remedy():
    without = [name for name in doors.DOORS if "--overwrite" not in doors.verbs()[name].format_help()]
    assert without == ["build"]  # which keeps the file


@pytest.mark.parametrize("name", doors.FOLDERS)
def test_a_folder_of_others_is_refused(name, tmp_path):
    path, check = doors.FOLDERS[name]
    (tmp_path / path).mkdir(parents=True)
    (tmp_path / path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="choose another"):
        check(tmp_path)
    (tmp_path / path).rename(tmp_path / "mine")
    if name != "convert":  # which writes no folder that exists
        (tmp_path / path).symlink_to(tmp_path / "mine")
        with pytest.raises(InputError, match="choose another"):
            check(tmp_path)
    (tmp_path / "run.toml").touch()
    with pytest.raises(InputError, match="is in the folder of a run"):
        check(tmp_path)


@pytest.mark.parametrize(("name", "path"), CASES)
def test_no_file_is_lost(name, path, tmp_path):
    for number, state in enumerate(doors.states(doors.DOORS[name], path)):
        folder = tmp_path / str(number)
        folder.mkdir()
        expected = EXPECTED[state] | (BLEND.get(state, set()) if path.endswith(".blend") else set())
        if path in MARKS and state != "own":
            expected = expected | {"refused"}
        assert doors.run(doors.DOORS[name], state, path, folder) in expected, state


@pytest.mark.parametrize("state", ["own", "full disk", "killed"])
def test_a_scene_file_is_not_lost(state, tmp_path):
    """Blender does not survive a fork, so `firetwin.export` is tried without it."""

    def save(*_):
        try:
            toml_update.save(Settings(path=Path("scene.toml"), run=Path("run"), cache=Path("cache")))
        except InputError as error:
            return doors.Call(1, str(error))
        return doors.Call(0, "")

    door = doors.Door(save, ("scene.toml",), lambda _: None)
    assert doors.run(door, state, "scene.toml", tmp_path) in EXPECTED[state]


def write(path, text, **more):
    output.write_text(path, text, **more)
    return path


def test_a_record_lists_what_was_written_as_sha256sum_does(tmp_path):
    write(tmp_path / "a.txt", "a")
    write(tmp_path / "a.txt", "b")
    path = write(tmp_path / "ü b.txt", "c")
    lines = (tmp_path / written.NAME).read_text().splitlines()
    assert [line.split("  ")[1] for line in lines] == ["a.txt", "a.txt", "ü b.txt"]
    assert lines[-1].split()[0] == written.digest(path)


def test_a_record_is_shortened_but_keeps_the_file_before(tmp_path, monkeypatch):
    monkeypatch.setattr(written, "_COMPACT", 1000)
    for number in range(40):
        write(tmp_path / "a.txt", str(number))
    found = written.read(tmp_path)
    assert len(found["a.txt"]) < 20
    assert found["a.txt"][-1] == written.digest(tmp_path / "a.txt")


@pytest.mark.parametrize("hostile", ["link", "folder", "huge", "pipe"])
def test_a_hostile_record_makes_nothing_ours(tmp_path, monkeypatch, hostile):

    path, record = write(tmp_path / "a.txt", "a"), tmp_path / written.NAME
    content = record.read_bytes()
    record.unlink()
    if hostile == "link":
        (tmp_path / "elsewhere").write_bytes(content)
        record.symlink_to(tmp_path / "elsewhere")
    elif hostile == "folder":
        record.mkdir()
    elif hostile == "pipe":
        os.mkfifo(record)
    else:
        monkeypatch.setattr(written, "_MOST", 10)
        record.write_bytes(content)
    with pytest.raises(InputError, match="Firetwin did not write it"):
        write(path, "b")
    assert path.read_text() == "a"


def test_devices_pipes_and_folders_of_runs_are_refused_always(tmp_path):

    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "run.toml").touch()
    for path, reason in (
        (tmp_path / "pipe", "is a device or a pipe"),
        (Path("/dev/null"), "is a device or a pipe"),
        (tmp_path / "run" / "maps" / "x.png", "is in the folder of a run"),
    ):
        with pytest.raises(InputError, match=reason):
            write(path, "b", overwrite=True)


def test_a_blend_file_that_is_ours_leaves_the_kept_one(tmp_path):
    """An artist's file that a build kept is not replaced by the next build."""
    path, part = tmp_path / "x.blend", tmp_path / "part"

    def build(text):
        part.write_text(text)
        return output.publish_blend(part, path)

    path.write_text("artist")
    assert build("one") == tmp_path / "x.blend1"
    assert build("two") is None
    assert (path.read_text(), (tmp_path / "x.blend1").read_text()) == ("two", "artist")


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "/a", "a\\b", "c:x", "a\nb", "a\x1bb"])
def test_names_that_are_paths_are_no_names(name):
    assert not output.is_plain_name(name)
    assert output.is_plain_name(f"{name}-1".translate({ord(each): "x" for each in "./\\:\n\x1b"}))


if __name__ == "__main__":
    import operator_doors

    doors.print_table(doors.DOORS)
    operator_doors.print_table()
