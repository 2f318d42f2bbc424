"""`blender --command firetwin ...`, as far as the module goes: it never reads a command line."""

import json

import bpy
import pytest
from firetwin.ui import blender_command


@pytest.fixture
def call(monkeypatch):
    """The function that Blender calls after `--command firetwin`, registered with Blender."""
    registered = {}
    register = bpy.utils.register_cli_command

    def remember(name, function):
        registered[name] = function
        return register(name, function)

    monkeypatch.setattr(bpy.utils, "register_cli_command", remember)
    blender_command.register()
    yield registered["firetwin"]
    blender_command.unregister()


def test_it_does_what_the_command_line_does(call, run_folder, capsys):
    assert call(["info", str(run_folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["name"] == "Test"


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["--help"], 0, ""),
        (["render", "--help"], 0, ""),
        ([], 2, "required"),
        (["rendr"], 2, "invalid choice"),
        (["info", "missing"], 1, "missing"),
        (["build", "scene.toml", "-o", "scene.png"], 2, ".blend"),
    ],
)
def test_mistakes_end_in_an_exit_status_and_never_in_an_exception(call, arguments, status, said, capsys):
    assert call(arguments) == status
    assert said in capsys.readouterr().err


def test_it_can_be_registered_again_after_it_was_taken_back(call):
    blender_command.unregister()
    blender_command.register()
    assert len(blender_command._handles) == 1
