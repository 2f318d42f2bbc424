"""Test files that changed files touch, nearest first: ``touched.py FILE...``; tests/quick.sh runs them.

Near is, in this order: a changed test; a test that bears the name of the changed module; one that imports it,
itself or by a helper; one that bears the name of its folder, or imports a module that imports it. Of C++ the
module is that of the folder's bindings, and a header's users count as changed. What would take more than a
minute on two processors, by the times of the last run of each file, is left out, and their number said.
"""

from __future__ import annotations

import ast
import functools
import json
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
ROOMS = ("unit", "blender", "render")
PACKAGES = {"addon": ("firetwin",), "data": ("firetwin", "data")}
SECONDS = ROOT / "build/tests/seconds.json"
"""Of each test file, written by tests/conftest.py."""
MOST = 70.0  # seconds of tests, which two workers run in little more than half of that
UNKNOWN = 5.0  # seconds of a file that has never run


def tests() -> list[Path]:
    """Every test file of the rooms that tests/quick.sh knows."""
    return [path for room in ROOMS for path in sorted((ROOT / "tests" / room).glob("test_*.py"))]


def module(path: Path) -> tuple[str, ...]:
    """Parts of the full name of a Python module of the package; none for other files."""
    folder, *rest = path.relative_to(ROOT).with_suffix("").parts
    return (*PACKAGES[folder], *(part for part in rest if part != "__init__")) if folder in PACKAGES else ()


@functools.cache
def imports(path: Path) -> frozenset[str]:
    """Full names of what a file imports, modules and their members alike, with that of the tests' helpers."""
    found = set()
    package = module(path) if path.name == "__init__.py" else module(path)[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            name = ".".join((*above, *([node.module] if node.module else [])))
            found |= {name, *(f"{name}.{alias.name}" for alias in node.names)}
    for helper in [ROOT / "tests/helpers" / f"{name}.py" for name in found]:
        if helper.exists() and helper != path:
            found |= imports(helper)
    return frozenset(found)


@functools.cache
def names(path: Path) -> frozenset[str]:
    """What tests import a changed file by."""
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
    """Full name of the bindings of a C++ file's folder; those of everything for what all bindings share."""
    folder = path.stem.split("_")[0] if path.parent.name == "bindings" else path.parent.name
    return {f"firetwin_core.{folder}" if (ROOT / "cpp" / folder).is_dir() else "firetwin_core"}


@functools.cache
def users(path: Path) -> frozenset[str]:
    """Full names of the package's modules that import this one."""
    mine = names(path)
    every = [each for folder in PACKAGES for each in (ROOT / folder).rglob("*.py")]
    return frozenset(".".join(module(each)) for each in every if imports(each) & mine)


def distance(test: Path, changed: Path) -> int | None:
    """How near a test is to a changed file, 0 the nearest; None: it is not."""
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
    """Each test that is near any of these files, nearest first, quick before slow, as many as are quick."""
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
        print(f"quick: {left} more files of tests are near; tests/run.sh runs them", file=sys.stderr)


if __name__ == "__main__":
    for test in nearest([ROOT / name for name in sys.argv[1:]]):
        print(test.relative_to(ROOT))
