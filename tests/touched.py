"""Tests near changed files, nearest first: ``touched.py FILE...``; tests/quick.sh runs them.

The order is: changed tests; tests with the name of a changed module; tests that import it, directly or by a
helper; tests with the name of its folder, and tests that import a module that imports it. The module of a C++
file is the binding of its folder, and users of a header count as changed. Tests that would take more than a
minute in total on two processors, by the last times of each file, are omitted, and their number is printed.
"""

from __future__ import annotations

import functools
import json
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
ROOMS = ("unit", "blender", "render")
PACKAGES = {"addon": ("firetwin",), "data": ("firetwin", "data")}
SECONDS = ROOT / "build/tests/seconds.json"
"""Processor seconds of test files, written by tests/conftest.py."""
MOST = 70.0  # processor seconds of tests; two workers need a little more than half of that
UNKNOWN = 5.0  # seconds of a file that has never run


@functools.cache
def tests() -> list[Path]:
    """Find all test files of the rooms of tests/quick.sh."""
    return [path for room in ROOMS for path in sorted((ROOT / "tests" / room).rglob("test_*.py"))]


def module(path: Path) -> tuple[str, ...]:
    """Split the full name of a Python module of the package; empty for other files."""
    folder, *rest = path.relative_to(ROOT).with_suffix("").parts
    return (*PACKAGES[folder], *(part for part in rest if part != "__init__")) if folder in PACKAGES else ()


SCANS = {
    "addon/cli.py": ("*/command.py", "commands/*.py"),
    "addon/shot/passes.py": ("passes/*.py", "*/passes/*.py"),
}
"""Files that find others by the registry."""
IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+(?P<dots>\.*)(?P<origin>[\w.]*)[ \t]+import[ \t]+(?P<members>\([^)]*\)|[^(\n]+)"
    r"|import[ \t]+(?P<modules>[^\n]+))",
    re.MULTILINE,
)  # a line of a docstring that looks like an import adds a name that no module has


def _words(names: str) -> list[str]:
    """Split the names of an import statement; omit comments and aliases."""
    return [each.split()[0] for each in re.sub(r"#.*|[()]", "", names).split(",") if each.strip()]


@functools.cache
def imports(path: Path) -> frozenset[str]:
    """Find the full names of modules and members that a file imports, directly or by a test helper."""
    names = set()
    for pattern in SCANS.get(path.relative_to(ROOT).as_posix(), ()):
        names |= {".".join(module(each)) for each in (ROOT / "addon").glob(pattern)}
    package = module(path) if path.name == "__init__.py" else module(path)[:-1]
    for match in IMPORT.finditer(path.read_text(encoding="utf-8")):
        if match["modules"]:
            names |= set(_words(match["modules"]))
        else:
            level = len(match["dots"])
            above = package[: len(package) - level + 1] if level else ()
            name = ".".join((*above, *([match["origin"]] if match["origin"] else [])))
            names |= {name, *(f"{name}.{each}" for each in _words(match["members"]))}
    for helper in [ROOT / "tests/helpers" / f"{name}.py" for name in names if "." not in name]:
        if helper.exists() and helper != path:
            names |= imports(helper)
    return frozenset(names)


@functools.cache
def names(path: Path) -> frozenset[str]:
    """Find the names by which tests import a changed file."""
    if module(path):
        return frozenset({".".join(module(path))})
    if path.suffix not in (".cpp", ".hpp"):
        return frozenset()
    header = path.with_suffix(".hpp")
    lines = [f'#include "{name}"' for name in (f"{path.parent.name}/{header.name}", header.name)]
    users = [
        each
        for each in ROOT.glob("cpp/*/*.?pp")
        if any(line in each.read_text(encoding="utf-8") for line in lines[: 1 + (each.parent == path.parent)])
    ]
    return frozenset().union(*map(binding, [path, *users]))


def binding(path: Path) -> set[str]:
    """Name the binding of a C++ file's folder; the complete module for files that all bindings share."""
    folder = path.stem.split("_")[0] if path.parent.name == "bindings" else path.parent.name
    return {f"firetwin_core.{folder}" if (ROOT / "cpp" / folder).is_dir() else "firetwin_core"}


@functools.cache
def importers() -> dict[str, set[str]]:
    """Find the full names of the package's modules that import each name."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in (path for folder in PACKAGES for path in (ROOT / folder).rglob("*.py")):
        for name in imports(path):
            found[name].add(".".join(module(path)))
    return found


@functools.cache
def users(path: Path) -> frozenset[str]:
    """Find the full names of the package's modules that import a file."""
    return frozenset().union(*(importers().get(name, ()) for name in names(path)))


def distance(test: Path, changed: Path) -> int | None:
    """Return the distance of a test from a changed file, 0 for the nearest; None if it is not near."""
    if changed == test:
        return 0
    if changed.parent == ROOT / "tests/helpers":
        return 1 if changed.stem in imports(test) else None
    if changed.name == "conftest.py":
        return 3 if test.is_relative_to(changed.parent) else None
    if not names(changed):
        return 1 if changed.name in test.read_text(encoding="utf-8") else None
    words, folder = test.stem.removeprefix("test_"), changed.parent.name
    if words == changed.stem or words.startswith(f"{changed.stem}_"):
        return 1
    if imports(test) & names(changed):
        return 2
    if words == folder or words.startswith(f"{folder}_") or imports(test) & users(changed):
        return 3
    return None


def nearest(changed: list[Path]) -> Iterator[Path]:
    """Yield tests near these files, nearest first, quick before slow, as many as fit into the time."""
    known = json.loads(SECONDS.read_text()) if SECONDS.exists() else {}
    near = []
    for test in tests():
        found = [d for each in changed if (d := distance(test, each)) is not None]
        if found:
            near.append((min(found), known.get(test.relative_to(ROOT).as_posix(), UNKNOWN), test))
    total, left = 0.0, 0
    for far, seconds, test in sorted(near):
        total += seconds
        if total > MOST and far > 0:
            left += 1
        else:
            yield test
    if left:
        print(f"quick: {left} more test files are near; tests/run.sh runs them", file=sys.stderr)


if __name__ == "__main__":
    for test in nearest([ROOT / name for name in sys.argv[1:]]):
        print(test.relative_to(ROOT))
