"""Makes the C++ table of docstrings from the stubs: ``python documentation.py STUBS OUT.cpp``.

The stubs hold every docstring, once. A public name without one ends this with an error.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

HEAD = """\
// Made by cpp/bindings/documentation.py from the stubs.
#include "documentation.hpp"

namespace firetwin::bindings {

const std::map<std::string, const char*>& documentation_table() {
  static const std::map<std::string, const char*> table{
"""
TAIL = """\
  };
  return table;
}

} // namespace firetwin::bindings
"""


def entries(stubs: Path) -> Iterator[tuple[str, str]]:
    """Name within the module, such as ``flux.Emitters.cell``, and what ``help`` says of it."""
    for path in sorted(stubs.glob("*.pyi")):
        tree = ast.parse(path.read_text(encoding="utf-8"), path.name)
        scope = "" if path.stem == "__init__" else path.stem
        yield scope, docstring(tree, path.stem)
        yield from members(tree.body, f"{scope}." if scope else "")


def members(body: list[ast.stmt], scope: str) -> Iterator[tuple[str, str]]:
    """Classes with their members, functions and properties."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            yield scope + node.name, docstring(node, scope + node.name)
            yield from members(node.body, f"{scope}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            decorators = [ast.unparse(decorator) for decorator in node.decorator_list]
            text = docstring(node, scope + node.name)
            if not decorators:
                text = f"{node.name}({parameters(node.args)})\n--\n\n{text}"
            elif decorators != ["property"]:
                sys.exit(f"{scope}{node.name}: {', '.join(decorators)} is unknown to {__file__}")
            yield scope + node.name, text


def parameters(arguments: ast.arguments) -> str:
    """Names and defaults, as Python's own C functions carry them to ``inspect.signature``: without types."""
    for argument in ast.walk(arguments):
        if isinstance(argument, ast.arg):
            argument.annotation = None
    text = ast.unparse(arguments)
    return text.replace("float('inf')", "1e999")  # no call may stand there


def docstring(node: ast.Module | ast.ClassDef | ast.FunctionDef, name: str) -> str:
    """The docstring; special methods may do without."""
    text = ast.get_docstring(node)
    if text is None and not name.rpartition(".")[2].startswith("__"):
        sys.exit(f"{name} has no docstring in the stubs")
    return text or ""


def main(stubs: Path, out: Path) -> None:
    """Write the table."""
    lines = [f'      {{"{name}", R"doc({text})doc"}},\n' for name, text in entries(stubs)]
    out.write_text(HEAD + "".join(lines) + TAIL, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
