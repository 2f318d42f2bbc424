"""The layers: rules that the import contracts in pyproject.toml cannot express."""

from __future__ import annotations

import graphlib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
PLACES = {"firetwin": ROOT / "addon", "firetwin.data": ROOT / "data"}

NEVER_BPY = (
    *(
        "firetwin.database",
        "firetwin.errors",
        "firetwin.leases",
        "firetwin.escaped",
        "firetwin.memory",
        "firetwin.plugins",
        "firetwin.progress",
    ),
    *("firetwin.cli", "firetwin.command", "firetwin.commands", "firetwin.data"),
    *("firetwin.run", "firetwin.stations", "firetwin.tiles"),
    *("firetwin.imaging", "firetwin.passes", "firetwin.shot", "firetwin.smoke", "firetwin.auto_framing"),
    *(
        "firetwin.jobs",
        "firetwin.farm",
        "firetwin.bench",
        "firetwin.brief",
        "firetwin.allocation",
        "firetwin.growing",
    ),
    *("firetwin.camera_import", "firetwin.delivery", "firetwin.edit", "firetwin.export"),
    *(
        f"firetwin.render.{name}"
        for name in (
            *("crate", "fingerprint", "films", "manifest", "picture", "plan", "png"),
            *("sharing", "store", "verify"),
        )
    ),
    *(f"firetwin.scene.fire.{name}" for name in ("firebrands", "flames", "lamps")),
    *(f"firetwin.scene.forest.{name}" for name in ("fire_effects", "stand", "understorey", "visibility")),
)
"""Packages and modules that load without Blender; `run` to `smoke` never import it at all."""

WITH_BPY = {
    *(
        f"firetwin.export.{name}"
        for name in (
            *("read_scene", "usd_cameras", "usd_fire", "usd_forest", "usd_geometry", "usd_georeference"),
            *("usd_materials", "usd_places", "usd_smoke", "usd_terrain"),
        )
    ),
    "firetwin.jobs.device",
    "firetwin.jobs.worker_scene",
    "firetwin.data.spread",
    "firetwin.data.simulate",
}
"""Exceptions: modules of the worker process, and modules that need packages to make the sample."""


def modules() -> dict[str, Path]:
    """Every module of the package by its full name."""
    paths = {}
    for package, folder in PLACES.items():
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder).with_suffix("").parts
            if "__pycache__" not in parts:
                paths[".".join((package, *parts)).removesuffix(".__init__")] = path
    return paths


MODULES = modules()


IMPORT = re.compile(r"^from (\.+)([\w.]*) import (\([^)]*\)|[^(\n]+)", re.MULTILINE)


def imports(name: str) -> set[str]:
    """Modules of the package that a module imports as it loads: not within functions, not for types alone."""
    path = MODULES[name]
    package = name if path.stem == "__init__" else name.rpartition(".")[0]
    names: set[str] = set()
    for dots, module, members in IMPORT.findall(path.read_text(encoding="utf-8")):
        above = package.split(".")[: len(package.split(".")) + 1 - len(dots)]
        origin = ".".join(filter(None, (*above, module)))
        inner = {f"{origin}.{each}" for each in re.findall(r"(\w+)(?: as \w+)?", members)}
        names |= {each if each in MODULES else origin for each in inner}
    return names


def test_no_import_goes_in_a_circle():
    graph = {name: imports(name) & set(MODULES) - {name} for name in MODULES}
    for name in graph:  # whoever imports a module has its packages imported, but they do not import back
        graph[name] -= {name.rpartition(".")[0]}
    graphlib.TopologicalSorter(graph).prepare()


def test_nobody_imports_a_feature():
    """A feature is a folder with a command; also imports within functions count."""
    features = {path.parent.name for path in (ROOT / "addon").glob("*/command.py")}
    assert {"brief", "farm"} <= features
    for name, path in MODULES.items():
        own = name.split(".")[1:2]
        for line in re.findall(r"^ *from (\.\.+\w*)[\w.]* import (.*)$", path.read_text(), re.MULTILINE):
            level = len(line[0]) - len(line[0].lstrip("."))
            if level != len(name.split(".")) - (path.stem != "__init__"):
                continue  # within the folder
            reached = {line[0].lstrip(".")} if line[0].strip(".") else {*re.split(r"[ ,]+", line[1])}
            assert not reached & (features - {*own}), f"{name} imports {reached & features}"


def _without_bpy() -> list[str]:
    return [
        name
        for name in MODULES
        if name not in WITH_BPY
        and ".panel" not in name
        and any(name == each or name.startswith(f"{each}.") for each in NEVER_BPY)
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


ABOUT_ALL = {
    "features",
    "floors",
    "handlers",
    "notebooks",
    "processor_time",
    "prose",
    "ragged_spread",
    "shown_commands",
    "touched",
    "documentation_artists",
    "documented_commands",
    "documentation_glossary",
}
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
