"""Budgets of rooms of tests: each test counts for one room, and a room far above its budget fails a run."""

import processor_time
from processor_time import Account, Room, Speed, find_room, load_rooms


def test_the_longest_path_that_fits_pays():
    rooms = load_rooms()
    assert find_room(rooms, "tests/unit/tiles/servers/test_a.py::test_a[b::c]").name == "unit/tiles/servers"
    assert find_room(rooms, "tests/system/farm/test_new.py::test_a").name == "system/farm"
    assert find_room(rooms, "tests/system/test_new.py::test_a").name == "system"


def test_each_test_file_has_a_room_and_each_room_a_file():
    files = [
        path.relative_to(processor_time.TESTS).as_posix() for path in processor_time.TESTS.rglob("test_*.py")
    ]
    rooms = load_rooms()
    assert {find_room(rooms, file).name for file in files} == {room.name for room in rooms}


def test_a_room_above_its_budget_is_named_and_fails_beyond_the_factor():
    account, room = Account(), Room("unit", 10.0)
    account.add("tests/unit/test_a.py::test_b", 24.0, 0.5)  # a machine of half the speed
    account.compare(1.5, [room])
    assert account.failures == []
    assert account.table[1].split() == ["unit", "24.0", "12.0", "10", "over", "budget"]
    account.add("tests/unit/test_a.py::test_c", 8.0, 0.5)
    account.compare(1.5, [room])
    assert account.failures == [
        "unit takes 16.0 reference seconds, and its budget is 10; "
        "make its tests cheaper, or raise the budget in tests/budget.toml"
    ]
    assert account.files() == {"tests/unit/test_a.py": 32.0}


def test_the_speed_is_measured_again_after_some_seconds_of_work(monkeypatch):
    clock, loops = [100.0], [0.014, 0.014, 0.014, 0.007, 0.007, 0.007]
    monkeypatch.setattr(processor_time, "processor_s", lambda: clock[0])
    monkeypatch.setattr(processor_time, "loop_s", lambda: loops.pop(0))
    monkeypatch.setattr(processor_time, "LOOP_S", 0.007)
    speed = Speed()
    factors = []
    for passed in (0.0, 1.0, 10.0):
        clock[0] += passed
        speed.measure()
        factors.append(speed.factor)
    assert factors == [0.5, 0.5, 1.0]


def test_the_contributing_page_lists_each_room_with_its_budget():
    page = (processor_time.TESTS.parent / "CONTRIBUTING.md").read_text()
    table = page.partition("## What the tests prove")[2].partition("\n## ")[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in table.splitlines()
        if line[:1] == "|"
    ]
    assert {(name, seconds) for name, _, seconds in rows[2:]} == {
        (room.name, f"{room.budget_s:g}") for room in load_rooms()
    }
