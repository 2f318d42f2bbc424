"""Operators, panels and properties; each file lists its classes."""

import bpy

from . import command, project

classes = (*project.classes,)


def register() -> None:
    """Register every class, the scene's properties and the command `blender --command firetwin`."""
    for cls in classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.firetwin = bpy.props.PointerProperty(type=project.FIRETWIN_PG_project)
    command.register()


def unregister() -> None:
    """Undo `register` in reverse order."""
    command.unregister()
    del bpy.types.Scene.firetwin
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
