"""The house: who may import whom. `python tests/unit/test_floors.py` prints who does, folder by folder."""

from __future__ import annotations

import ast
import graphlib
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PLACES = {"firetwin": ROOT / "addon", "firetwin.data": ROOT / "data"}

BASE = {"errors", "escaped", "files", "memory", "progress"}
FLOORS: dict[str, set[str]] = {
    "errors": set(),
    "escaped": set(),
    "files": {"errors"},
    "memory": set(),
    "progress": {"escaped"},
    "data": {"errors"},
    "blender": {"errors"},
    "run": BASE | {"data"},
    "imaging": set(),
    "shot": BASE | {"run", "imaging"},
    "smoke": BASE | {"run", "shot"},
    "scene": BASE | {"run", "shot", "smoke", "blender"},
    "render": BASE | {"run", "shot", "smoke", "blender", "scene"},
    "jobs": BASE | {"data", "run", "shot", "smoke", "blender", "scene", "render"},
    "bench": BASE | {"data", "run", "shot", "smoke", "blender", "scene", "render", "jobs"},
    "commands": BASE | {"data", "run", "shot", "render", "jobs", "bench"},
    "cli": BASE | {"commands", "shot"},
    "ui": BASE | {"run", "shot", "smoke", "blender", "scene", "render", "jobs", "cli"},
    "__main__": {"cli"},
    "__init__": {"ui"},
}
"""From the ground up: each folder (or file beside them), and those that it may import."""

NEVER_BPY = (
    *("firetwin.errors", "firetwin.escaped", "firetwin.memory", "firetwin.progress"),
    *("firetwin.cli", "firetwin.commands", "firetwin.data"),
    *("firetwin.run", "firetwin.imaging", "firetwin.shot", "firetwin.smoke"),
    *("firetwin.jobs", "firetwin.bench"),
    *(
        f"firetwin.render.{name}"
        for name in (
            *("database", "fingerprint", "films", "leases", "manifest", "picture", "plan", "png"),
            *("sharing", "store", "verify"),
        )
    ),
    *(f"firetwin.scene.fire.{name}" for name in ("firebrands", "flames", "lamps")),
    *(f"firetwin.scene.forest.{name}" for name in ("fire_effects", "stand", "understorey", "visibility")),
)
"""Packages and modules that load without Blender; those of `run` to `smoke` never ask for it at all."""

WITH_BPY = {"firetwin.jobs.worker_scene", "firetwin.data.spread", "firetwin.data.simulate"}
"""In those packages: what runs in the worker process alone, and what needs packages to make the sample."""


def modules() -> dict[str, Path]:
    """Every module of the package by its full name."""
    found = {}
    for package, folder in PLACES.items():
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder).with_suffix("").parts
            if "__pycache__" not in parts:
                found[".".join((package, *parts)).removesuffix(".__init__")] = path
    return found


MODULES = modules()


def imports(name: str, inside_functions: bool = True) -> set[str]:
    """Modules of the package, and others, that a module imports, by their full names.

    Without those inside of functions also without those that only types need.
    """
    path = MODULES[name]
    package = name if path.stem == "__init__" else name.rpartition(".")[0]
    found: set[str] = set()
    pending: list[ast.AST] = [ast.parse(path.read_text(encoding="utf-8"))]
    while pending:
        node = pending.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not inside_functions:
            continue
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING" and not inside_functions:
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = (
                ".".join(package.split(".")[: len(package.split(".")) + 1 - node.level]) if node.level else ""
            )
            origin = ".".join(filter(None, (base, node.module)))
            inner = {f"{origin}.{alias.name}" for alias in node.names}
            found |= {each if each in MODULES else origin for each in inner}
        pending += ast.iter_child_nodes(node)
    return found


def floor(name: str) -> str:
    """The folder, or file beside the folders, that a module is in."""
    return name.split(".")[1] if "." in name else "__init__"


def picture() -> dict[str, dict[str, int]]:
    """Folder -> folders that it imports, and by how many of its modules."""
    found: dict[str, dict[str, int]] = {name: {} for name in FLOORS}
    for name in MODULES:
        here = floor(name)
        used = {floor(each) for each in imports(name) if each in MODULES}
        for each in used - {here}:
            found[here][each] = found[here].get(each, 0) + 1
    return found


def test_the_floors_stand_on_each_other():
    known: set[str] = set()
    for name, allowed in FLOORS.items():
        assert allowed <= known, name
        known.add(name)


def test_every_module_is_on_a_floor():
    assert {floor(name) for name in MODULES} == set(FLOORS)


@pytest.mark.parametrize("name", sorted(MODULES))
def test_nothing_is_imported_from_above(name):
    wrong = {
        each
        for each in imports(name)
        if each in MODULES and floor(each) not in FLOORS[floor(name)] | {floor(name)}
    }
    assert not wrong


def test_no_import_goes_in_a_circle():
    graph = {name: imports(name, inside_functions=False) & set(MODULES) - {name} for name in MODULES}
    for name in graph:  # whoever imports a module has its packages imported, but they do not import back
        graph[name] -= {name.rpartition(".")[0]}
    graphlib.TopologicalSorter(graph).prepare()


def test_rooms_of_a_scene_do_not_go_in_a_circle():
    rooms = {path.parent.name for path in (ROOT / "addon" / "scene").glob("*/__init__.py")}
    graph: dict[str, set[str]] = {room: set() for room in rooms}
    for name in MODULES:
        parts = name.split(".")
        if parts[1:2] == ["scene"] and len(parts) == 4:
            used = {each.split(".")[2] for each in imports(name) if each.startswith("firetwin.scene.")}
            graph[parts[2]] |= used & rooms - {parts[2]}
    graphlib.TopologicalSorter(graph).prepare()


def _without_bpy() -> list[str]:
    return [
        name
        for name in MODULES
        if name not in WITH_BPY and any(name == each or name.startswith(f"{each}.") for each in NEVER_BPY)
    ]


def test_what_needs_no_blender_loads_without_it():
    code = """
import importlib, sys
for name in ("bpy", "mathutils", "bpy_extras"):
    sys.modules[name] = None
for name in sys.argv[1:]:
    importlib.import_module(name)
"""
    command = [sys.executable, "-c", code, *_without_bpy()]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize(
    "name", [name for name in MODULES if floor(name) in ("run", "imaging", "shot", "smoke", "data")]
)
def test_what_lies_below_scene_never_asks_for_blender(name):
    assert not imports(name) & {"bpy", "mathutils", "bpy_extras"}


ABOUT_ALL = {"floors", "touched", "documentation_artists", "documentation_glossary"}
"""Test files about the project rather than one module of it."""


def test_a_test_file_bears_the_name_of_the_module_that_it_tests():
    sources = [
        path for folder in ("addon", "cpp", "data", "tests/benchmarks") for path in (ROOT / folder).rglob("*")
    ]
    names = {"benchmarks"} | {path.stem.strip("_") for path in sources if "__pycache__" not in path.parts}
    for path in (ROOT / "tests").glob("*/test_*.py"):
        words = path.stem.split("_")[1:]
        starts = {"_".join(words[:count]) for count in range(1, len(words) + 1)}
        assert starts & names or "_".join(words) in ABOUT_ALL, f"{path}: which module does it test?"


if __name__ == "__main__":
    for here, used in reversed(picture().items()):
        print(f"{here:<9} -> {', '.join(f'{name} ({count})' for name, count in sorted(used.items())) or '-'}")
