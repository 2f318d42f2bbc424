"""Optional features: an installation without their packages."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from firetwin import optional_features
from scene_text import DRONE, NO_PLANTS, NO_SMOKE, TINY

ADDON = Path(optional_features.__file__).parent
PACKAGES = sorted(set(optional_features.COMMANDS.values()))
SCENE = 'run = "{run}"\n[time]\nframes = 1\n' + NO_PLANTS + NO_SMOKE + TINY + DRONE
REGISTER = "import firetwin; firetwin.register(); firetwin.unregister()"
IMPORT_ALL = """
import bpy, importlib, pkgutil, firetwin
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
def test_a_feature_is_not_needed_by_the_others(python_without, package):
    python = python_without([package])
    python("-c", IMPORT_ALL.format(packages=set(PACKAGES) - {package}))
    python("-c", REGISTER)


@pytest.mark.parametrize("package", PACKAGES)
def test_the_command_of_a_missing_feature_explains_it_in_one_line(python_without, package):
    python = python_without([package])
    command = next(name for name, its in optional_features.COMMANDS.items() if its == package)
    ended = python("-m", "firetwin", command, "scene.toml", status=2)
    assert ended.stderr == (
        f"firetwin: the command {command} needs firetwin/{package}, which is missing; reinstall Firetwin\n"
    )
    listed = python("-m", "firetwin", "--help").stdout.splitlines()
    assert not any(line.startswith(f"    {command} ") for line in listed)
    assert any(line.startswith("    render ") for line in listed)


def test_a_scene_is_built_and_rendered_without_optional_features(python_without, run_folder, tmp_path):
    python = python_without(PACKAGES)
    scene, blend, film = tmp_path / "scene.toml", tmp_path / "scene.blend", tmp_path / "film"
    scene.write_text(SCENE.format(run=run_folder))
    python("-m", "firetwin", "build", scene, "-o", blend)
    python("-m", "firetwin", "render", scene, "--out", film, "--passes", "depth")
    assert blend.stat().st_size > 0
    assert list(film.glob("drone/depth/*.exr"))
    python("-c", REGISTER)
