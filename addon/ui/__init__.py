"""Operators, panels and properties; each file lists its classes."""

import bpy

from . import (
    build,
    cameras_panel,
    command,
    maps,
    open,
    preferences,
    properties,
    quality,
    render,
    report,
    rows,
    run,
    section_panels,
    time,
    working,
)

classes = (
    *preferences.classes,
    *properties.classes,
    *working.classes,
    *rows.classes,
    *run.classes,
    *open.classes,
    *quality.classes,
    *build.classes,
    *time.classes,
    *cameras_panel.classes,
    *render.classes,
    *section_panels.classes,
    *report.classes,
)


def register() -> None:
    """Register every class, the scene's properties and the command `blender --command firetwin`."""
    for cls in classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.firetwin = bpy.props.PointerProperty(type=properties.FIRETWIN_PG_scene)
    command.register()
    open.register()


def unregister() -> None:
    """Undo `register` in reverse order; work that still goes on is ended."""
    working.abandon()
    maps.forget()
    open.unregister()
    command.unregister()
    del bpy.types.Scene.firetwin
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
