"""`blender --command firetwin ...`: the same command line inside Blender's own executable."""

import bpy

_handles: list[object] = []


def run(arguments: list[str]) -> int:
    """Run the command line; returns its exit code."""
    from .. import cli

    return cli.main(arguments)


def register() -> None:
    """Make the command known to Blender."""
    _handles.append(bpy.utils.register_cli_command("firetwin", run))


def unregister() -> None:
    """Take the command back."""
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
