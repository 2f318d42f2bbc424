"""Command ``blender --command firetwin ...``: the same command line inside Blender's own executable."""

import bpy

_handles: list[object] = []


def run(arguments: list[str]) -> int:
    """Run the command line and return its exit code, also if argparse exits, as for --help."""
    from .. import cli

    try:
        return cli.main(arguments)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)


def register() -> None:
    """Register the command with Blender."""
    _handles.append(bpy.utils.register_cli_command("firetwin", run))


def unregister() -> None:
    """Unregister the command."""
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
