"""Operators, panels and properties; each file lists its classes."""

import bpy

from . import (
    aims,
    assets,
    background,
    build,
    cameras_panel,
    command,
    flying,
    foreign,
    go,
    maps,
    named,
    open,
    other_runs_panel,
    preferences,
    properties,
    quality,
    queue,
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
    *other_runs_panel.classes,
    *foreign.classes,
    *open.classes,
    *quality.classes,
    *build.classes,
    *time.classes,
    *cameras_panel.classes,
    *flying.classes,
    *aims.classes,
    *go.classes,
    *named.classes,
    *render.classes,
    *background.classes,
    *section_panels.classes,
    *report.classes,
    *assets.classes,
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
    queue.clear()
    maps.forget()
    open.unregister()
    command.unregister()
    del bpy.types.Scene.firetwin
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
