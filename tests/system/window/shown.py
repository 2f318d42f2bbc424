"""Pictures of all that the add-on shows: panels, menus, dialogs and preferences."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
from hands import FOLDER, MODULE, alone, call, check, here, idle, keys, picture, settings, soon, tab, ui, view

_BLENDERS_MENUS = ("TOPBAR_MT_file_import", "TOPBAR_MT_file_export", "VIEW3D_MT_add")


def sections() -> Iterator[object]:
    """Open every panel alone, and every menu; built objects are hidden, because drawing them takes long."""
    for thing in bpy.context.scene.objects:
        thing.hide_set(True)
    known = [each for each in ui().classes if issubclass(each, bpy.types.Panel)]
    for top in (each for each in known if not hasattr(each, "bl_parent_id")):
        name = f"20-panel-{top.bl_label.lower().replace(' ', '-')}"
        yield from alone(top.bl_idname, lambda name=name: picture(name))
    own = [each.__name__ for each in ui().classes if issubclass(each, bpy.types.Menu)]
    asked = [_asking("firetwin.camera_add", "kind"), _asking("firetwin.camera_aim", "target")]
    for name in (*_BLENDERS_MENUS, *own, *(each.__name__ for each in asked)):
        with bpy.context.temp_override(**here()):
            bpy.ops.wm.call_menu(name=name)
        yield 1
        picture(f"21-menu-{name.lower()}")
        keys("Escape")
        yield 1
    for each in asked:
        bpy.utils.unregister_class(each)
    for thing in bpy.context.scene.objects:
        thing.hide_set(False)


def _asking(operator: str, name: str) -> type[bpy.types.Menu]:
    """The menu that a button opens which asks for one of several."""

    def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
        self.layout.operator_enum(operator, name)

    label = f"FIRETWIN_MT_test_{operator.partition('.')[2]}"
    menu = type(label, (bpy.types.Menu,), {"bl_label": name, "draw": draw})
    bpy.utils.register_class(menu)
    return menu


def dialogs() -> Iterator[object]:
    """Dialogs that confirm, file browsers, and the preferences."""
    for name in ("preset", "remove"):
        call(getattr(bpy.ops.firetwin, name))
        yield 1
        picture(f"22-dialog-{name}")
        keys("Escape")
        yield 1
    for name in ("open", "export"):
        call(getattr(bpy.ops.firetwin, name))
        yield 3
        yield from window_picture(f"22-files-{name}", "File View", lambda: bpy.ops.file.cancel())
    bpy.ops.preferences.addon_show(module=MODULE)
    yield 3
    yield from window_picture("22-preferences", "Preferences", bpy.ops.wm.window_close)


def window_picture(name: str, title: str, close: Callable[[], object]) -> Iterator[object]:
    """A picture of the window that was opened last; then it goes."""
    window = bpy.context.window_manager.windows[-1]
    if len(bpy.context.window_manager.windows) > 1:
        subprocess.run(["xdotool", "search", "--name", title, "windowmove", "60", "40"], check=False)
        yield 1
    picture(name)
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        close()
    yield 1


def drop() -> Iterator[object]:
    """A run's file is dragged from a file manager onto the view."""
    bpy.ops.wm.read_homefile()
    yield 3
    place = next(region for region in view().regions if region.type == "WINDOW")
    height = bpy.context.window_manager.windows[0].height
    where = (str(place.x + 300), str(height - place.y - place.height // 2))
    script, file = Path(__file__).with_name("drag.py"), FOLDER / "sample/run.toml"
    dragged = subprocess.Popen(["/usr/bin/python3", str(script), str(file), "Blender", *where])
    yield soon(lambda: dragged.poll() is not None)
    check(dragged.poll() == 0, f"the view takes a run.toml that is dropped on it ({dragged.poll()})")
    yield soon(lambda: settings().run != "", 30.0)
    yield 1
    yield idle
    yield 1
    check(settings().run == str(file.parent), f"and opens it: {settings().run}")
    view().spaces.active.show_region_ui = True
    yield 2
    tab()
    yield 1
    picture("24-dropped")
