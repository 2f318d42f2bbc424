"""`help` has the texts of the stubs, and the stubs have the content of the module."""

import ast
import importlib
import inspect
import subprocess
import sys
from pathlib import Path

import firetwin_core as core
import numpy as np
import pytest

ROOT = Path(__file__).parents[3]
STUBS = ROOT / "cpp" / "bindings" / "firetwin_core-stubs"
GENERATOR = ROOT / "cpp" / "bindings" / "documentation.py"


def names():
    """Every module, class, function, method and property of the stubs: its place in them and its node."""
    for path in sorted(STUBS.glob("*.pyi")):
        module = "firetwin_core" if path.stem == "__init__" else f"firetwin_core.{path.stem}"
        tree = ast.parse(path.read_text(encoding="utf-8"))
        yield module, (), tree
        for node in tree.body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef):
                yield module, (node.name,), node
            for member in node.body if isinstance(node, ast.ClassDef) else ():
                if isinstance(member, ast.FunctionDef):
                    yield module, (node.name, member.name), member


def found(module, path):
    thing = importlib.import_module(module)
    for name in path:
        thing = inspect.getattr_static(thing, name) if inspect.isclass(thing) else getattr(thing, name)
    return thing


@pytest.mark.parametrize(
    ("module", "path", "node"), [pytest.param(*name, id=".".join((name[0], *name[1]))) for name in names()]
)
def test_help_says_what_the_stub_says(module, path, node):
    written = ast.get_docstring(node)
    said = inspect.cleandoc(found(module, path).__doc__ or "")
    assert said == (written or "")
    assert written or path[-1].startswith("__"), "a public name without a docstring"


def functions():
    """Functions, methods and constructors: what calls them, and their node."""
    for module, path, node in names():
        if isinstance(node, ast.FunctionDef) and not node.decorator_list:
            if path[-1] == "__init__":
                yield pytest.param(module, path[:-1], node, id=".".join((module, *path)))
            elif not path[-1].startswith("__"):
                yield pytest.param(module, path, node, id=".".join((module, *path)))


def defaults(arguments):
    """Names in order, those that are keywords alone, and the values of those that may be left out."""
    optional = arguments.args[len(arguments.args) - len(arguments.defaults) :] + arguments.kwonlyargs
    plain = {}
    for argument, default in zip(optional, arguments.defaults + arguments.kw_defaults, strict=True):
        if default is not None:
            value = eval(ast.unparse(default).replace("float('inf')", "inf"), {"inf": float("inf")})
            value = float(np.float32(value)) if isinstance(value, float) else value
            plain[argument.arg] = list(value) if isinstance(value, tuple) else value
    named = [[each.arg for each in some] for some in (arguments.args, arguments.kwonlyargs)]
    return [name for name in named[0] if name != "self"], named[1], plain


@pytest.mark.parametrize(("module", "path", "node"), list(functions()))
def test_what_is_bound_takes_what_the_stub_says(module, path, node):
    """pybind11 reports its signature if a call has unknown arguments."""
    thing = importlib.import_module(module)
    for name in path:
        thing = getattr(thing, name)
    with pytest.raises(TypeError) as error:
        thing(there_is_no_such_argument=1)
    line = next(line for line in str(error.value).splitlines() if line.startswith("    1. "))
    text = line[line.index("(") : line.rindex(")") + 1]
    bound = ast.parse(f"def f{text}: ...").body[0]
    said, written = defaults(bound.args), defaults(node.args)
    said[2].update({name: value for name, value in written[2].items() if value is ...})  # lists
    assert said == written


def test_signatures_are_seen_by_tools():
    """With names and defaults, so that editors and `help` show them."""
    signature = inspect.signature(core.run.Run.frames)
    assert str(signature) == "(self, field='heat_flux', indices=None, ahead=8)"
    assert list(inspect.signature(core.flux.at_time).parameters) == ["run", "time"]


def generate(tmp_path, text):
    stubs = tmp_path / "stubs"
    stubs.mkdir()
    (stubs / "thing.pyi").write_text(text)
    out = tmp_path / "out.cpp"
    command = [sys.executable, GENERATOR, stubs, out]
    return subprocess.run(command, capture_output=True, text=True), out


def test_a_name_without_a_docstring_fails_the_build(tmp_path):
    result, out = generate(tmp_path, '"""A."""\ndef f(x: int, y: float = 2.0) -> int: ...\n')
    assert result.returncode != 0
    assert "thing.f has no docstring" in result.stderr
    assert not out.exists()


STUB = """\
'''A.'''
class C:
    '''B.'''
    def f(self, y: float = 2.0) -> int:
        '''Does.

        More.
        '''
"""


def test_what_is_made_for_the_build(tmp_path):
    result, out = generate(tmp_path, STUB)
    assert result.returncode == 0, result.stderr
    made = out.read_text()
    assert '{"thing", R"doc(A.)doc"}' in made
    assert '{"thing.C", R"doc(B.)doc"}' in made
    assert '{"thing.C.f", R"doc(f(self, y=2.0)\n--\n\nDoes.\n\nMore.)doc"}' in made


def declared(body):
    """Public names that statements of a stub define; a class may declare attributes of its instances."""
    named = [node for node in body if isinstance(node, ast.ClassDef | ast.FunctionDef)]
    return {node.name for node in named if not node.name.startswith("_")}


def bound(thing):
    """Public names of a module or class of the core."""
    return {name for name, value in vars(thing).items() if name[0] != "_" and not inspect.ismodule(value)}


def test_what_is_bound_has_a_stub():
    """The other way is tested above."""
    for module, path, node in names():
        thing = found(module, path)
        if not isinstance(node, ast.FunctionDef):
            values = [each for each in node.body if isinstance(each, ast.AnnAssign)] if not path else []
            constants = {each.target.id: ast.unparse(each.annotation).partition("[")[0] for each in values}
            assert bound(thing) == declared(node.body) | {name for name in constants if name[0] != "_"}
            assert {name: type(getattr(thing, name)).__name__ for name in constants} == constants
