"""Plugins: modules found in folders, so that a new one needs no list; names of helpers begin with "_".

The number `ORDER` of a module decides its rank: 0 without one. Modules of one rank are in order of names.
"""

from __future__ import annotations

import ast
import importlib
import pkgutil
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any


def module(package: str, name: str) -> ModuleType:
    """Import a module of a package."""
    return importlib.import_module(f"{package}.{name}")


def modules(package: str, function: str = "") -> dict[str, ModuleType]:
    """Import all modules of a loaded package, and return those that have a function, in order."""
    listed = pkgutil.iter_modules(sys.modules[package].__path__)
    found = {name: module(package, name) for name in sorted(each.name for each in listed) if name[0] != "_"}
    ranked = sorted(found.items(), key=lambda item: getattr(item[1], "ORDER", 0))
    return {name: each for name, each in ranked if not function or hasattr(each, function)}


def values(package: str, constant: str) -> dict[str, Any]:
    """Import all modules of a loaded package, and return a constant that each of them has, in order."""
    return {name: getattr(each, constant) for name, each in modules(package).items()}


def of_features(name: str) -> tuple[ModuleType, ...]:
    """Import the module or package `name` of each feature that has it, such as ``panel``.

    A feature is a folder with ``command.py``.
    """
    package, features = str(__package__), sorted(Path(__file__).parent.glob("*/command.py"))
    having = (
        each.parent
        for each in features
        if any(map(Path.exists, (each.with_name(name), each.with_name(f"{name}.py"))))
    )
    return tuple(module(f"{package}.{each.name}", name) for each in having)


def declared(folders: Path | Sequence[Path], constant: str) -> dict[str, Any]:
    """Read a literal constant of those modules of folders that have it, in order; none is imported."""
    listed = [folders] if isinstance(folders, Path) else folders
    files = [path for folder in listed for path in sorted(folder.glob("[!_]*.py"))]
    texts = {path.stem: path.read_text(encoding="utf-8") for path in files}
    found = {name: _literals(text, constant) for name, text in texts.items() if f"\n{constant} = " in text}
    ranked = sorted(found.items(), key=lambda item: item[1].get("ORDER", 0))
    return {name: each[constant] for name, each in ranked}


def _literals(text: str, constant: str) -> dict[str, Any]:
    lines = [node for node in ast.parse(text).body if isinstance(node, ast.Assign)]
    named = {node.targets[0].id: node.value for node in lines if isinstance(node.targets[0], ast.Name)}
    return {name: ast.literal_eval(named[name]) for name in (constant, "ORDER") if name in named}
