"""Add-on user interface: operators, panels and properties; each file lists its classes."""

import atexit

import bpy

from . import (
    asset_library,
    assets,
    background,
    blender_command,
    build,
    camera_targets,
    cameras_panel,
    feature_panels,
    fly,
    foreign,
    former_names,
    go_to,
    keymap,
    manual,
    maps,
    menus,
    navigation,
    open,
    other_runs_panel,
    panel_state,
    place_names,
    preferences,
    properties,
    quality,
    queue,
    regrade,
    render,
    report,
    rows,
    run,
    section_panels,
    smoke_volumes,
    stations_panel,
    tile_credits,
    tiles_panel,
    time,
    translations,
    viewport,
    vr,
    working,
)

classes = (
    *preferences.classes,
    *properties.classes,
    *working.classes,
    *manual.classes,
    *rows.classes,
    *run.classes,
    *other_runs_panel.classes,
    *foreign.classes,
    *open.classes,
    *quality.classes,
    *build.classes,
    *smoke_volumes.classes,
    *time.classes,
    *cameras_panel.classes,
    *navigation.classes,
    *fly.classes,
    *camera_targets.classes,
    *go_to.classes,
    *vr.classes,
    *place_names.classes,
    *render.classes,
    *viewport.classes,
    *background.classes,
    *regrade.classes,
    *section_panels.classes,
    *stations_panel.classes,
    *feature_panels.classes,
    *tiles_panel.classes,
    *report.classes,
    *assets.classes,
    *menus.classes,
)


def register() -> None:
    """Register every class, the scene's properties and the command `blender --command firetwin`.

    Python with Blender as a module (`bpy`) crashes or hangs at its end while Blender refers to functions or
    classes of Python. It then calls `unregister` at exit.
    """
    for cls in classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.firetwin = bpy.props.PointerProperty(type=properties.FIRETWIN_PG_scene)
    blender_command.register()
    open.register()
    menus.register()
    manual.register()
    keymap.register()
    asset_library.register()
    translations.register()
    former_names.register()
    panel_state.register()
    smoke_volumes.register()
    stations_panel.register()
    tile_credits.register()
    feature_panels.register()
    viewport.register()
    vr.register()
    if bpy.app.module:
        atexit.register(unregister)


def unregister() -> None:
    """Undo `register` in reverse order; running tasks are cancelled. A second call has no effect."""
    if not hasattr(bpy.types.Scene, "firetwin"):  # Blender also disables its add-ons at exit
        return
    atexit.unregister(unregister)
    working.cancel_task()
    queue.clear()
    vr.unregister()
    viewport.unregister()
    feature_panels.unregister()
    maps.clear()
    tile_credits.unregister()
    stations_panel.unregister()
    smoke_volumes.unregister()
    panel_state.unregister()
    former_names.unregister()
    translations.unregister()
    asset_library.unregister()
    keymap.unregister()
    manual.unregister()
    menus.unregister()
    open.unregister()
    blender_command.unregister()
    del bpy.types.Scene.firetwin
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
