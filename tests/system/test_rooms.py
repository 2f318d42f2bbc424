"""Rooms of the top floor: what works in an installation without them."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from firetwin import rooms
from scene_text import DRONE, NO_PLANTS, NO_SMOKE, TINY

ADDON = Path(rooms.__file__).parent
ROOMS = sorted(set(rooms.COMMANDS.values()))
SCENE = 'run = "{run}"\n[time]\nframes = 1\n' + NO_PLANTS + NO_SMOKE + TINY + DRONE
REGISTER = "import firetwin; firetwin.register(); firetwin.unregister()"
IMPORT_ALL = """
import importlib, pkgutil, firetwin
for each in pkgutil.walk_packages(firetwin.__path__, "firetwin."):
    if each.name.split(".")[1] in {rooms}:
        importlib.import_module(each.name)
"""


@pytest.fixture(scope="module")
def python_without(tmp_path_factory):
    """Run Python with a copy of the package that has no folders of these rooms: python(rooms)(arguments)."""

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


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_is_not_needed_by_the_others(python_without, room):
    python = python_without([room])
    python("-c", IMPORT_ALL.format(rooms=set(ROOMS) - {room}))
    python("-c", REGISTER)


@pytest.mark.parametrize("room", ROOMS)
def test_the_command_of_a_missing_room_says_so_in_a_line(python_without, room):
    python = python_without([room])
    command = next(name for name, package in rooms.COMMANDS.items() if package == room)
    ended = python("-m", "firetwin", command, "scene.toml", status=2)
    assert ended.stderr == (
        f"firetwin: the command {command} needs the package firetwin/{room}, which is missing; "
        "reinstall Firetwin\n"
    )
    listed = python("-m", "firetwin", "--help").stdout.splitlines()
    assert not any(line.startswith(f"    {command} ") for line in listed)
    assert any(line.startswith("    render ") for line in listed)


def test_a_scene_is_built_and_rendered_without_any_room(python_without, run_folder, tmp_path):
    python = python_without(ROOMS)
    scene, blend, film = tmp_path / "scene.toml", tmp_path / "scene.blend", tmp_path / "film"
    scene.write_text(SCENE.format(run=run_folder))
    python("-m", "firetwin", "build", scene, "-o", blend)
    python("-m", "firetwin", "render", scene, "--out", film, "--passes", "depth")
    assert blend.stat().st_size > 0
    assert list(film.glob("drone/depth/*.exr"))
    python("-c", REGISTER)
