"""Tiles in the window: boxes, coarse tiles and credits of a set of the sample's own ground; Esc goes back."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import bpy
from hands import FOLDER, MODULE, built, busy, call, check, here, idle, picture, settings, soon, tab, view


def tiles() -> Iterator[object]:
    """Boxes first, then tiles; a second preview is stopped, and the scene is as it was."""
    bpy.ops.wm.read_homefile()
    yield 3
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    settings().scene_file = str(FOLDER / "scene.toml")
    yield 2
    yield idle
    settings().tiles.sources = str(FOLDER / "tileset")
    settings().tiles.use_geoid, settings().tiles.geoid = True, -24.9
    call(bpy.ops.firetwin.tiles_preview, boxes=True)
    yield 0.5
    yield idle
    yield 1
    check("Firetwin Tile Boxes" in built(), f"boxes are shown: {', '.join(built())}")
    check(_credits().shown(), "credits are drawn over the view")
    picture("25-tile-boxes")
    before = sorted(built())
    call(bpy.ops.firetwin.tiles_preview)
    yield 0.5
    check(busy(), "tiles are fetched in the background")
    yield soon(lambda: any("Tile Preview" in name for name in built()))
    with bpy.context.temp_override(**here()):
        bpy.ops.firetwin.stop()
    yield idle
    yield 2
    check(sorted(built()) == before, f"stopped, the scene is as it was: {', '.join(built())}")
    call(bpy.ops.firetwin.tiles_preview)
    yield 0.5
    yield idle
    yield 2
    check(any("Tile Preview" in name for name in built()), "coarse tiles are shown")
    check("Film" in settings().tile_facts, f"the film's are ready: {settings().tile_facts[:200]}")
    picture("26-tiles")
    call(bpy.ops.firetwin.tiles_clear)
    yield 1
    check(not _credits().shown(), "and gone, with their credits")


def _credits() -> object:
    return sys.modules[f"{MODULE}.ui.tile_credits"]
