"""Features: an installation without the folder of one, and with the folder of another."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import firetwin
import pytest
from firetwin import plugins
from scene_text import DRONE, NO_PLANTS, NO_SMOKE, TINY

ADDON = Path(firetwin.__file__).parent
DECLARED = {each.__name__.split(".")[-2]: each for each in plugins.of_features("command")}
PACKAGES = list(DECLARED)
COMMANDS = {package: each.COMMAND.name for package, each in DECLARED.items() if hasattr(each, "COMMAND")}
SCENE = 'run = "{run}"\n[time]\nframes = 1\n' + NO_PLANTS + NO_SMOKE + TINY + DRONE
REGISTER = "import firetwin; firetwin.register(); firetwin.unregister()"
IMPORT_ALL = """
import bpy, importlib, pkgutil, firetwin, firetwin.ui  # panels are imported by it
bpy.utils.expose_bundled_modules()  # pxr
for each in pkgutil.walk_packages(firetwin.__path__, "firetwin."):
    if each.name.split(".")[1] in {packages}:
        importlib.import_module(each.name)
"""


@pytest.fixture(scope="module")
def python_without(tmp_path_factory):
    """Run Python with a copy of the package without some packages: python_without(packages)(arguments)."""

    def copy(absent):
        folder = tmp_path_factory.mktemp("package")
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(
            ADDON,
            folder / "firetwin",
            ignore=lambda path, names: (
                {*ignored(path, names), *(absent if path == str(ADDON) else ())} & set(names)
            ),
        )
        shutil.copytree(ADDON.parent / "data", folder / "firetwin" / "data", ignore=ignored)

        def run(*arguments, status=0):
            ended = subprocess.run(
                [sys.executable, *map(str, arguments)],
                cwd=folder,
                env=os.environ | {"PYTHONPATH": str(folder)},
                capture_output=True,
                text=True,
            )
            assert ended.returncode == status, ended.stderr
            return ended

        return run

    return copy


@pytest.mark.parametrize("package", PACKAGES)
def test_a_missing_feature_has_no_command_and_is_not_needed_by_the_others(python_without, package):
    python = python_without([package])
    python("-c", IMPORT_ALL.format(packages=set(PACKAGES) - {package}))
    python("-c", REGISTER)
    listed = python("-m", "firetwin", "--help").stdout.splitlines()
    if command := COMMANDS.get(package):
        ended = python("-m", "firetwin", command, "scene.toml", status=2)
        assert f"invalid choice: '{command}'" in ended.stderr
        assert not any(line.startswith(f"    {command} ") for line in listed)
    assert any(line.startswith("    render ") for line in listed)


def test_a_missing_feature_has_no_options_in_other_commands(python_without):
    python = python_without(["forecasts", "growing"])
    for command, option in (("brief", "--ensemble"), ("convert", "--members"), ("render", "--follow")):
        assert option not in python("-m", "firetwin", command, "--help").stdout


FEATURE = {
    "__init__.py": "",
    "command.py": """
from ..command import MACHINE, Command

COMMAND = Command("greet", "print a greeting", "", MACHINE, run=lambda arguments: print("hello"))
""",
    "panel.py": """
import bpy
from ..ui.menu_entries import MenuEntry
from ..ui.sidebar import SidebarPanel

class FIRETWIN_OT_greet(bpy.types.Operator):
    bl_idname, bl_label = "firetwin.greet", "Greet"

class FIRETWIN_PT_greeting(SidebarPanel, bpy.types.Panel):
    bl_label = "Greeting"

    def draw(self, context):
        pass

class properties:
    __annotations__ = {"greeting": bpy.props.StringProperty()}

def unregister():
    pass

classes = (FIRETWIN_OT_greet, FIRETWIN_PT_greeting)
menu = {"Help": (MenuEntry("greet"),)}
""",
}
REGISTERED = """
import bpy, firetwin, os, traceback
from firetwin.ui.menus import MENUS
try:
    firetwin.register()
    assert hasattr(bpy.types, "FIRETWIN_PT_greeting")
    assert "greeting" in bpy.context.scene.firetwin.bl_rna.properties
    assert any(getattr(line, "operator", "") == "greet" for line in MENUS["Help"])
    firetwin.unregister()
    assert not hasattr(bpy.types, "FIRETWIN_PT_greeting")
except BaseException:
    traceback.print_exc()
    os._exit(1)
os._exit(0)  # Python's own end can hang with `bpy` loaded
"""


def test_a_feature_is_added_by_its_folder_alone(python_without):
    python = python_without([])
    folder = Path(python("-c", "import firetwin; print(firetwin.__path__[0])").stdout.strip()) / "greeting"
    folder.mkdir()
    for name, text in FEATURE.items():
        (folder / name).write_text(text)
    assert python("-m", "firetwin", "greet").stdout == "hello\n"
    assert "    greet     print a greeting" in python("-m", "firetwin", "--help").stdout
    python("-c", REGISTERED)


def test_a_scene_is_built_and_rendered_without_optional_features(python_without, run_folder, tmp_path):
    python = python_without(PACKAGES)
    scene, blend, film = tmp_path / "scene.toml", tmp_path / "scene.blend", tmp_path / "film"
    scene.write_text(SCENE.format(run=run_folder))
    python("-m", "firetwin", "build", scene, "-o", blend)
    python("-m", "firetwin", "render", scene, "--out", film, "--passes", "depth")
    assert blend.stat().st_size > 0
    assert list(film.glob("drone/depth/*.exr"))
    python("-c", REGISTER)
