"""All operators that write files for their user follow the rule of commands (see `test_doors`)."""

import sys

import doors
import operator_table
import pytest
from firetwin.errors import InputError
from firetwin.jobs import sample
from operator_doors import DOORS, NO_DOORS, SILENT

pytestmark = pytest.mark.usefixtures("registered")

EXPECTED = {
    "own": {doors.REPLACED},
    "own, changed": {"refused", "kept as .blend1"},
    "own, changed, --overwrite": {doors.REPLACED, "kept as .blend1"},
    "another's file": {"refused", "kept as .blend1"},
    "another's folder": {"refused"},
    "others beside it": {"stays"},
    "link": {"refused", "kept as .blend1"},
    "write-protected": {"refused"},
    **({"full disk": {"refused"}} if sys.platform == "linux" else {}),  # a limit of the size of files
}
"""Outcomes; the writers of all doors are killed in `test_doors`, as Blender does not survive a fork."""
CASES = [(name, path) for name, door in DOORS.items() for path in door.outputs]


def test_every_operator_is_a_door_or_known_to_be_none():
    """A new operator fails here until `operator_doors` has a press of it."""
    assert sorted([*DOORS, *NO_DOORS, *SILENT]) == sorted(operator_table.operators())


@pytest.mark.parametrize(("name", "path"), CASES)
def test_no_file_is_lost(name, path, tmp_path):
    for number, state in enumerate(set(doors.states(DOORS[name], path)) & EXPECTED.keys()):
        folder = tmp_path / str(number)
        folder.mkdir()
        if not (name == "export" and "--overwrite" in state):  # a scene file is updated
            assert doors.run(DOORS[name], state, path, folder) in EXPECTED[state], state


def test_the_sample_run_is_not_put_into_a_folder_of_others(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="is not the sample run; choose another folder"):
        sample.run(tmp_path)
    with pytest.raises(InputError, match="is not the sample run; choose another folder"):
        sample.run(tmp_path / "mine.txt")
