"""Panel Viewport: film or live scene, hidden parts with reasons, and the cost of a frame."""

from . import facts, overlay, panel

classes = panel.classes


def register() -> None:
    """Follow changes of scenes, and draw over the 3D views."""
    facts.register()
    overlay.register()


def unregister() -> None:
    """Undo `register`."""
    overlay.unregister()
    facts.unregister()
