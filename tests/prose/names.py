"""Names of variables that say nothing: ``found``, ``known`` and ``made`` in place of the object itself."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

VARIABLES = {"found", "known", "made"}
DEFINITIONS = {"Here", "_alone"}
LINES = 5  # between binding and last use
FOLDERS = ("addon", "data", "docs", "examples", "tests")

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda


class Name(NamedTuple):
    """A name to replace, the line of its binding and the lines from there to its last use."""

    path: str
    line: int
    name: str
    lines: int


def read_names(path: str, text: str) -> Iterator[Name]:
    """Find definitions with such a name, and variables and parameters that live longer than `LINES`."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name in DEFINITIONS:
            yield Name(path, node.lineno, node.name, 0)
    for scope in (tree, *(node for node in ast.walk(tree) if isinstance(node, Function))):
        lines, bound = defaultdict(list), set()
        for name, line, is_bound in _uses(scope):
            lines[name].append(line)
            if is_bound:
                bound.add(name)
        for name in sorted(bound):
            first, last = min(lines[name]), max(lines[name])
            if last - first > LINES:
                yield Name(path, first, name, last - first)


def _uses(scope: ast.AST) -> Iterator[tuple[str, int, bool]]:
    """Read uses of `VARIABLES` in a scope, without functions and classes in it: name, line, True if bound."""
    nodes = list(ast.iter_child_nodes(scope))
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.Name) and node.id in VARIABLES:
            yield node.id, node.lineno, isinstance(node.ctx, ast.Store)
        elif isinstance(node, ast.arg) and node.arg in VARIABLES:
            yield node.arg, node.lineno, True
        if isinstance(node, Function | ast.ClassDef):
            nodes += [] if isinstance(node, ast.ClassDef) else node.args.defaults
        else:
            nodes += ast.iter_child_nodes(node)


def collect(root: Path) -> list[Name]:
    """Collect the names in `FOLDERS`."""
    return [
        name
        for folder in FOLDERS
        for path in sorted((root / folder).rglob("*.py"))
        if "out" not in path.parts
        for name in read_names(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8"))
    ]
