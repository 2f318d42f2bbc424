"""Operators, panels and properties; each file lists its classes."""

import bpy

from . import assets, build, command, preferences, properties, render, run, time, working

classes = (
    *preferences.classes,
    *properties.classes,
    *working.classes,
    *run.classes,
    *build.classes,
    *time.classes,
    *render.classes,
    *assets.classes,
)


def register() -> None:
    """Register every class, the scene's properties and the command `blender --command firetwin`."""
    for cls in classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.firetwin = bpy.props.PointerProperty(type=properties.FIRETWIN_PG_scene)
    command.register()


def unregister() -> None:
    """Undo `register` in reverse order; work that still goes on is ended."""
    working.abandon()
    command.unregister()
    del bpy.types.Scene.firetwin
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
