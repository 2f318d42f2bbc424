"""Firetwin: fly through and film the output of a coupled fire-atmosphere model."""


def register() -> None:
    """Add Firetwin's panel, operators and command to Blender."""
    from . import ui

    ui.register()


def unregister() -> None:
    """Take away everything that `register` added."""
    from . import ui

    ui.unregister()
