"""Processor time of tests, their child processes included, and the budget of each room of tests.

A room is a folder of tests with a budget in ``tests/budget.toml``. The time of a test is the
processor time of its setup, call and teardown, so a shared fixture counts for the room that uses it first.

Machines differ in speed by a factor of two to three, and busy processors slow each other down. Therefore each
process repeats a fixed loop of interpreter and NumPy work after every few seconds of tests, and its times are
scaled to a machine on which the loop takes `LOOP_S`. Budgets are in these reference seconds. The scaled sum
of a room still varies by about 20 %, so a room above its budget is named, and a run fails if a room exceeds
its budget by the factor ``budget_factor`` (1.5). Coverage and sanitizers slow the tests but not the loop:
give ``-o budget_factor=5`` there. No test measures wall time.
"""

from __future__ import annotations

import json
import os
import time
import tomllib
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np

TESTS = Path(__file__).parents[1]
BUDGET = TESTS / "budget.toml"
LOOP_S = 0.007  # of the loop on the reference machine: one core of a 2-core virtual machine
SLOWEST = 10  # tests that the table lists
BETWEEN_S = (
    4.0  # processor seconds from one measurement of the speed to the next; three loops are 0.5 % of it
)


def processor_s() -> float:
    """Measure the processor seconds of this process and of its ended child processes so far."""
    return sum(os.times()[:4])


def loop_s() -> float:
    """Measure the processor seconds of the loop: dictionaries, strings, JSON and sorted arrays."""
    numbers = np.random.default_rng(1).random(60_000)
    began = time.process_time()
    words = {f"{n}:{n * 7919 % 1009}": n for n in range(12_000)}
    json.loads(json.dumps(sorted(words, key=words.__getitem__)[::2]))
    for _ in range(3):
        np.sort(numbers).cumsum()
    return time.process_time() - began


class Speed:
    """Speed of this process relative to the reference machine."""

    def __init__(self) -> None:
        self.factor = 1.0  # reference seconds per processor second
        self._measured_s: float | None = None  # processor seconds of the last measurement

    def measure(self) -> None:
        """Measure the factor again after some seconds of work."""
        now = processor_s()
        if self._measured_s is None or now - self._measured_s > BETWEEN_S:
            # A clock of Windows has steps of 16 ms.
            self.factor = LOOP_S / max(sorted(loop_s() for _ in range(3))[1], 0.1 * LOOP_S)
            self._measured_s = now


@dataclass(frozen=True)
class Room:
    """A room of tests, by the beginning of its path in tests, and its budget in reference seconds."""

    name: str
    budget_s: float


def load_rooms(path: Path = BUDGET) -> list[Room]:
    """Read the rooms."""
    return [
        Room(name, budget_s) for name, budget_s in tomllib.loads(path.read_text(encoding="utf-8")).items()
    ]


def find_room(rooms: list[Room], test: str) -> Room:
    """Find the room of a test by its node id, relative to the root of the repository."""
    file = test.split("::")[0].removeprefix("tests/")
    fitting = [room for room in rooms if file.startswith((f"{room.name}/", f"{room.name}."))]
    return max(fitting, key=lambda room: len(room.name), default=Room("other", 0.0))


class Account:
    """Times of the tests of a run, summed over all of its processes."""

    def __init__(self) -> None:
        self.tests: dict[str, float] = defaultdict(float)  # processor seconds by node id
        self.reference: dict[str, float] = defaultdict(float)  # reference seconds by node id
        self.total_s = 0.0  # processor seconds of all processes, with imports and collection
        self.table: list[str] = []
        self.failures: list[str] = []

    def add(self, test: str, seconds: float, speed: float) -> None:
        """Add the time of a phase of a test."""
        self.tests[test] += seconds
        self.reference[test] += seconds * speed

    def files(self) -> dict[str, float]:
        """Sum the processor seconds of each test file."""
        sums: dict[str, float] = defaultdict(float)
        for test, seconds in self.tests.items():
            sums[test.split("::")[0]] += seconds
        return {name: round(seconds, 1) for name, seconds in sums.items()}

    def compare(self, factor: float, rooms: list[Room] | None = None) -> None:
        """Compare the rooms with their budgets: write the table and the failures."""
        rooms = load_rooms() if rooms is None else rooms
        seconds: dict[Room, float] = defaultdict(float)
        reference: dict[Room, float] = defaultdict(float)
        for test in self.tests:
            room = find_room(rooms, test)
            seconds[room] += self.tests[test]
            reference[room] += self.reference[test]
        self.table = [f"{'room':<24}{'processor s':>12}{'reference s':>12}{'budget':>8}"]
        for room in sorted(reference, key=reference.__getitem__, reverse=True):
            took = reference[room]
            line = f"{room.name:<24}{seconds[room]:12.1f}{took:12.1f}{room.budget_s:8g}"
            self.table.append(line + ("  over budget" if took > room.budget_s else ""))
            if took > factor * room.budget_s:
                self.failures.append(
                    f"{room.name} takes {took:.1f} reference seconds, and its budget is {room.budget_s:g}; "
                    "make its tests cheaper, or raise the budget in tests/budget.toml"
                )
        total = sum(seconds.values())
        self.table.append(f"{'all tests':<24}{total:12.1f}{sum(reference.values()):12.1f}")
        self.table.append(f"{'imports and collection':<24}{self.total_s - total:12.1f}")
        slowest = sorted(self.tests, key=self.tests.__getitem__, reverse=True)[:SLOWEST]
        self.table += ["slowest:", *(f"{self.tests[each]:8.1f} s  {each}" for each in slowest)]
