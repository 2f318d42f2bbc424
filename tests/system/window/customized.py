"""Things a user sets up once: shortcuts, preferences, asset library and language."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
from hands import (
    FOLDER,
    MODULE,
    alone,
    built,
    call,
    check,
    idle,
    key_frames,
    keys,
    picture,
    ready,
    say,
    settings,
    soon,
    tab,
    view,
)
from shown import window_picture


def shortcuts() -> Iterator[object]:
    """Set camera keys with Ctrl Alt K, with K during Walk, and with the user's own key."""
    yield from ready()
    keymap = sys.modules[f"{MODULE}.ui.keymap"]
    for name in built():  # drawn slowly without a GPU
        bpy.context.scene.objects[name].hide_set(True)
    call(bpy.ops.firetwin.view, whole=True)
    view().spaces.active.region_3d.view_perspective = "PERSP"
    bpy.context.scene.frame_set(2)
    yield 2
    keys("ctrl+alt+k")
    yield soon(lambda: 2 in key_frames(), 20.0)
    check(2 in key_frames(), f"Ctrl Alt K sets a key: {key_frames()}")
    yield from _walk("k", "53-walking")
    item = keymap.users_items()[0][1]
    item.type = "J"
    for path in ("location", "rotation_quaternion"):
        bpy.context.scene.camera.keyframe_delete(path, frame=3)
    check(3 not in key_frames(), "the key of the camera is deleted")
    yield from _walk("j", "53-walking-own-key")
    keymap.users_items()[0][1].type = "K"  # `item` may be outdated
    for name in built():
        bpy.context.scene.objects[name].hide_set(False)


def _flying() -> set[str]:
    return {each.bl_idname for each in bpy.context.window_manager.windows[0].modal_operators}


def _walk(key: str, name: str) -> Iterator[object]:
    """Walk ahead, and press a key on the way in frame 3."""
    wanted = {"VIEW3D_OT_walk", "FIRETWIN_OT_fly"}
    bpy.context.scene.frame_set(3)
    keys("ctrl+alt+w")
    yield soon(lambda: wanted <= _flying(), 20.0)
    check(wanted <= _flying(), "Ctrl Alt W walks")
    for each in ("w", key):
        subprocess.run(["xdotool", "key", "--delay", "300", each], check=True)
        yield 1
    yield soon(lambda: 3 in key_frames(), 20.0)
    check(3 in key_frames(), f"{key.upper()} sets a key during Walk: {key_frames()}")
    picture(name)
    check(wanted <= _flying(), "and the walk goes on")
    subprocess.run(["xdotool", "key", "Return"], check=True)
    yield soon(lambda: not wanted & _flying(), 20.0)
    check(not wanted & _flying(), "Return ends it")


def cache() -> Iterator[object]:
    """The cache folder of the preferences gets the smoke of a new scene; its limit removes old smoke."""
    own, folder = bpy.context.preferences.addons[MODULE].preferences, FOLDER / "own_cache"
    old = folder / ("0" * 16)
    old.mkdir(parents=True)
    (old / "smoke_000001.vdb").write_bytes(bytes(2000))
    for path in (*old.iterdir(), old):
        os.utime(path, (1.0e9, 1.0e9))
    own.cache, own.cache_limit = str(folder), 1.0e-6
    bpy.ops.wm.read_homefile()
    yield 2
    settings().run = str(FOLDER / "sample")
    yield 1
    yield idle
    call(bpy.ops.firetwin.quality, level="preview")
    settings().time.start, settings().time.end = "2014-09-17 16:00:00-07:00", "2014-09-17 16:24:00-07:00"
    settings().time.frames, settings().smoke.voxel_size = 2, 320.0
    settings().terrain.near_radius, settings().forest.budget = 2500.0, 2000
    yield 1
    call(bpy.ops.firetwin.build)
    yield 1
    yield idle
    smoke = [path for path in folder.rglob("smoke_*.vdb") if old not in path.parents]
    check(len(smoke) == 2, f"smoke volumes of a new scene in the cache folder: {len(smoke)}")
    check(not old.exists(), "smoke of another time beyond the limit is removed")
    own.cache, own.cache_limit = "", 0.0
    bpy.ops.wm.read_homefile()
    yield 2


def preferences() -> Iterator[object]:
    """Set the unit and the cache folder; the next Blender has them too."""
    yield from ready()
    own, folder = bpy.context.preferences.addons[MODULE].preferences, FOLDER / "own_cache"
    own.area_unit, own.cache = "ha", str(folder)
    bpy.ops.preferences.addon_show(module=MODULE)
    yield 3
    yield from window_picture("54-preferences", "Preferences", bpy.ops.wm.window_close)
    call(bpy.ops.firetwin.inspect)
    yield 1
    yield idle
    check(" ha" in settings().facts, "areas are in hectares")
    bpy.ops.wm.save_userpref()
    own_text = f"bpy.context.preferences.addons[{MODULE!r}].preferences"
    script = f"import bpy; own = {own_text}; print(own.area_unit, own.cache)"
    command = [bpy.app.binary_path, "--background", "--python-expr", script]
    other = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    check(f"ha {folder}" in other, "the next Blender has the same preferences")
    own.area_unit, own.cache = "acres", ""
    bpy.ops.wm.save_userpref()


def assets() -> Iterator[object]:
    """The asset library, written by the menu's operator, listed in the preferences, and browsed."""
    yield from ready()
    folder = FOLDER / "library"
    call(bpy.ops.firetwin.assets, directory=str(folder))
    yield 0.5
    yield idle
    check((folder / "firetwin_assets.blend").exists(), "the asset library is written")
    libraries = bpy.context.preferences.filepaths.asset_libraries
    check([Path(each.path) for each in libraries if each.name == "Firetwin"] == [folder], "and listed")
    catalogs = _catalogs(folder)
    check(len(catalogs) > 1, f"catalogs: {', '.join(name for _, name in catalogs)}")
    without = _without_preview(folder / "firetwin_assets.blend")
    pictured = [name for name in without if not name.startswith("Firetwin")]
    check(not pictured, f"trees and undergrowth have previews {pictured or ''}")
    say(f"assets without a preview: {without}")
    area = view()
    area.ui_type = "ASSETS"
    yield 3
    space = area.spaces.active
    space.params.asset_library_reference = "Firetwin"
    space.show_region_ui = False
    for identifier, name in catalogs:
        space.params.catalog_id = identifier
        yield 10  # pictures of trees come one after the other
        picture(f"23-assets-{name.lower().replace(' ', '-')}")
    area.ui_type = "VIEW_3D"
    yield 2
    tab()
    check(settings().run != "", "back in the 3D view")


def _catalogs(folder: Path) -> list[tuple[str, str]]:
    """Identifier and name of every catalog of a library."""
    lines = (folder / "blender_assets.cats.txt").read_text("utf-8").splitlines()
    found = [line.split(":") for line in lines if line.count(":") == 2]
    return [(each[0], each[1].rpartition("/")[2]) for each in found]


def _without_preview(path: Path) -> list[str]:
    """Names of the assets of a file that have no preview."""
    kinds = ("collections", "objects", "materials", "node_groups")
    with bpy.data.libraries.load(str(path), link=True, assets_only=True) as (source, target):
        for kind in kinds:
            setattr(target, kind, getattr(source, kind))
    found = [each for kind in kinds for each in getattr(target, kind)]
    bare = [each.name for each in found if each.preview is None or not any(each.preview.image_size)]
    check(len(found) > 5, f"{len(found)} assets")
    for library in [each for each in bpy.data.libraries if Path(bpy.path.abspath(each.filepath)) == path]:
        bpy.data.libraries.remove(library)
    return bare


def german() -> Iterator[object]:
    """The panel Scene in German."""
    own = bpy.context.preferences.view
    usual = own.language
    own.language = "de_DE"
    yield 2
    text = bpy.app.translations.pgettext_iface("Build scene")
    check(text == "Szene bauen", f"German: {text}")
    yield from alone("FIRETWIN_PT_build", lambda: picture("55-german"))
    own.language = usual
    yield 2
    text = bpy.app.translations.pgettext_iface("Build scene")
    check(text == "Build scene", f"English again: {text}")
