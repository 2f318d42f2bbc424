"""`help` says as much as the stubs, and the stubs say what the module has."""

import ast
import importlib
import inspect
import os
import shutil
import subprocess
import sys
from pathlib import Path

import firetwin_core as core
import pytest

ROOT = Path(__file__).parents[2]
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


@pytest.mark.parametrize(
    "name",
    [
        "set_threads",
        "flux.at_time",
        "lod.seen",
        "particles.state",
        "run.Run.frames",
        "geo.LocalFrame.__init__",
    ],
)
def test_signatures_are_those_of_the_stub(name):
    """With names and defaults, so that editors and `help` show them."""
    *module, last = name.split(".")
    owner = core
    for part in module:
        owner = getattr(owner, part)
    node = next(node for m, path, node in names() if ".".join((m, *path)) == f"firetwin_core.{name}")
    signature = inspect.signature(getattr(owner, last))
    assert list(signature.parameters) == [argument.arg for argument in node.args.args]
    optional = [p.name for p in signature.parameters.values() if p.default is not p.empty]
    assert (
        optional
        == [argument.arg for argument in node.args.args][-len(node.args.defaults) or None :][
            : len(node.args.defaults)
        ]
    )


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


def test_what_is_made_for_the_build(tmp_path):
    text = '"""A."""\nclass C:\n    """B."""\n    def f(self, y: float = 2.0) -> int:\n        """Does.\n\n        More."""\n'
    result, out = generate(tmp_path, text)
    assert result.returncode == 0, result.stderr
    made = out.read_text()
    assert '{"thing", R"doc(A.)doc"}' in made
    assert '{"thing.C", R"doc(B.)doc"}' in made
    assert '{"thing.C.f", R"doc(f(self, y=2.0)\n--\n\nDoes.\n\nMore.)doc"}' in made


def test_the_stubs_fit_the_module(tmp_path):
    """Names, parameters and defaults, both ways, by mypy's own check of stubs against a module."""
    pytest.importorskip("mypy")
    shutil.copytree(STUBS, tmp_path / "firetwin_core")
    (tmp_path / "mypy.ini").write_text("[mypy]\nignore_missing_imports = True\nfollow_imports = silent\n")
    command = [sys.executable, "-m", "mypy.stubtest", "firetwin_core", "--mypy-config-file", "mypy.ini"]
    result = subprocess.run(
        command,
        cwd=tmp_path,
        env=os.environ
        | {
            "MYPYPATH": str(tmp_path),
            "PYTHONPATH": os.pathsep.join(p for p in sys.path if p and p != str(tmp_path)),
        },
        capture_output=True,
        text=True,
    )
    assert result.returncode == 0, result.stdout + result.stderr
