"""Rules of all rooms: the folder of a test marks it, and tests of unit and blender are quick."""

from __future__ import annotations

import json
import time
from collections import defaultdict
from pathlib import Path

import hypothesis
import pytest

ROOMS = ("unit", "blender", "render", "system")
"""Folders of tests, by their needs; see CONTRIBUTING.md."""

hypothesis.settings.register_profile("firetwin", deadline=None)  # machines differ in speed
hypothesis.settings.register_profile("quick", deadline=None, max_examples=10)
hypothesis.settings.load_profile("firetwin")

SECONDS = Path(__file__).parents[1] / "build/tests/seconds.json"
"""Times of the last complete runs of test files, for tests/touched.py."""
_seconds: dict[str, float] = defaultdict(float)
_processor = pytest.StashKey[float]()


def pytest_addoption(parser):
    parser.addini(
        "longest_s", "processor seconds that an unmarked test of unit or blender may take", default="30"
    )


def pytest_collection_modifyitems(items):
    here = Path(__file__).parent
    for item in items:
        room = item.path.relative_to(here).parts[0]
        if room in ROOMS:
            item.add_marker(room)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    began = time.process_time()
    try:
        return (yield)
    finally:
        item.stash[_processor] = time.process_time() - began


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Fail a test of unit or blender that takes too long; shared fixtures do not count.

    Too long is 30 s of processor time or 180 s of wall time: 10 to 15 s on a fast idle machine,
    and shared processors are two to three times slower.
    """
    report = yield
    quick = item.get_closest_marker("unit") or item.get_closest_marker("blender")
    if quick and not item.get_closest_marker("slow") and report.when == "call" and report.passed:
        longest, took = float(item.config.getini("longest_s")), item.stash[_processor]
        if took > longest or report.duration > 6.0 * longest:
            report.outcome = "failed"
            report.longrepr = f"{item.nodeid} took {took:.1f} s of processor time; {longest:g} s are the most"
    return report


def pytest_runtest_logreport(report):
    _seconds[report.nodeid.split("::")[0]] += report.duration


def pytest_sessionfinish(session):
    """Save the times of files, unless single tests were chosen or this is one of several processes."""
    options = session.config.option
    chosen = options.keyword or options.markexpr or any("::" in each for each in session.config.args)
    if chosen or hasattr(session.config, "workerinput"):
        return
    known = json.loads(SECONDS.read_text()) if SECONDS.exists() else {}
    SECONDS.parent.mkdir(parents=True, exist_ok=True)
    new = {name: round(seconds, 1) for name, seconds in _seconds.items()}
    SECONDS.write_text(json.dumps(known | new, indent=0, sort_keys=True))
