"""Blender's VR session in a built scene: start and stop, landmarks, controllers, comfort and frame time."""

from . import controllers, display, moves, panel, session, teleport, viewer_landmarks

classes = (*viewer_landmarks.classes, *session.classes, *moves.classes, *teleport.classes, *panel.classes)


def register() -> None:
    """Register what sessions call."""
    controllers.register()


def unregister() -> None:
    """Stop drawing, restore session settings, and undo `register`."""
    session.restore()
    display.stop()
    controllers.unregister()
