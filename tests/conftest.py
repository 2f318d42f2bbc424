"""Rules of all rooms: the folder of a test marks it, tests of unit and blender are quick, rooms have budgets.

``tests/helpers/processor_time.py`` explains how the processor time of tests is measured and compared.
"""

from __future__ import annotations

import ctypes
import json
import os
import sys
import time
from pathlib import Path

import hypothesis
import hypothesis_profiles  # noqa: F401 -- registers the profiles
import pytest
from processor_time import Account, Speed, processor_s

ROOMS = ("unit", "blender", "render", "system")
"""Folders of tests, by their needs; see CONTRIBUTING.md."""

hypothesis.settings.load_profile("firetwin")

BUILD = Path(__file__).parents[1] / "build"
TIMES = BUILD / "tests"
"""Times of the last runs: processor seconds of files (for tests/touched.py), reference seconds of tests."""
_account, _speed = Account(), Speed()
_before = pytest.StashKey[float]()  # processor seconds before a phase of a test

if sys.dont_write_bytecode:  # worker and child processes would compile all modules again
    sys.dont_write_bytecode, sys.pycache_prefix = False, str(BUILD / "bytecode")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


WINDOWS = sys.platform == "win32"
if WINDOWS:  # a test that calls one of these is skipped there

    def _is_of_a_test() -> bool:
        return Path(__file__).parent in Path(sys._getframe(2).f_code.co_filename).parents

    def _skip(*_, **__):
        if _is_of_a_test():
            pytest.skip("Windows has no fork, no pipes among files, and no links without special rights")
        raise OSError("no links")

    def _unlink(path, missing_ok=False, unlink=Path.unlink):
        try:
            unlink(path, missing_ok)
        except PermissionError:
            if _is_of_a_test():
                pytest.skip("Windows removes no file that is open")
            raise

    Path.symlink_to = os.mkfifo = os.fork = _skip
    Path.unlink = _unlink
    if hasattr(ctypes.windll.ntdll, "wine_get_version"):  # lacks functions of C, and wakes of event loops
        sys.modules["netCDF4"] = sys.modules["zarr"] = None


def pytest_addoption(parser):
    parser.addini(
        "longest_s", "processor seconds that an unmarked test of unit or blender may take", default="30"
    )
    parser.addini("budget_factor", "a room that exceeds its budget by this factor fails a run", default="1.5")


def pytest_collection_modifyitems(items):
    here = Path(__file__).parent
    for item in items:
        room = item.path.relative_to(here).parts[0]
        if room in ROOMS:
            item.add_marker(room)
        if WINDOWS and (need := item.get_closest_marker("posix")):
            item.add_marker(pytest.mark.skip(reason=f"Windows has no {need.args[0]}"))


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item):
    _speed.measure()
    item.stash[_before] = processor_s()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Add the times of each phase, and fail a test of unit or blender that takes too long.

    Too long is 30 s of processor time, child processes included, or 180 s of wall time: 10 to 15 s on a fast
    idle machine, and shared processors are two to three times slower. Shared fixtures do not count.
    """
    now = processor_s()
    report = yield
    took, item.stash[_before] = now - item.stash[_before], now
    report.processor_s, report.speed = took, _speed.factor
    quick = item.get_closest_marker("unit") or item.get_closest_marker("blender")
    if quick and not item.get_closest_marker("slow") and report.when == "call" and report.passed:
        longest = float(item.config.getini("longest_s"))
        if took > longest or report.duration > 6.0 * longest:
            report.outcome = "failed"
            report.longrepr = f"{item.nodeid} took {took:.1f} s of processor time; {longest:g} s are the most"
    return report


def pytest_runtest_logreport(report):
    if hasattr(report, "processor_s"):
        _account.add(report.nodeid, report.processor_s, report.speed)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """Add the time of a worker process, imports and collection included."""
    _account.total_s += getattr(node, "workeroutput", {}).get("processor_s", 0.0)


def pytest_sessionfinish(session):
    """Compare the rooms with their budgets; save the times unless single tests were chosen."""
    if hasattr(session.config, "workerinput"):
        session.config.workeroutput["processor_s"] = processor_s()
        return
    _account.total_s += time.process_time() if _account.total_s else processor_s()
    factor = float(session.config.getini("budget_factor"))
    _account.compare(factor)
    if _account.failures and session.exitstatus == 0:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
    options = session.config.option
    if not (options.keyword or options.markexpr or any("::" in each for each in session.config.args)):
        TIMES.mkdir(parents=True, exist_ok=True)
        for name, new in (("seconds.json", _account.files()), ("tests.json", _account.reference)):
            path = TIMES / name
            known = json.loads(path.read_text()) if path.exists() else {}
            path.write_text(json.dumps(known | new, indent=0, sort_keys=True))


def pytest_terminal_summary(terminalreporter):
    if _account.tests:
        terminalreporter.section("processor time")
        for line in (*_account.table, *_account.failures):
            terminalreporter.line(line)
