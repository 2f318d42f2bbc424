"""A user's actions at the screen and their visible effects, written to session.log."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

FOLDER, *STEPS = sys.argv[sys.argv.index("--") + 1 :]
FOLDER = Path(FOLDER)
MODULE = "bl_ext.user_default.firetwin"
PATIENCE = float(os.environ.get("FIRETWIN_PATIENCE", "1800"))  # s, for anything, without a GPU
failures: list[str] = []
began = time.monotonic()

_KEYCODES = {f"F{number}": str(66 + number) for number in range(1, 11)}
"""X keycodes: by their names, xdotool presses function keys with Alt."""


def say(text: str) -> None:
    line = f"{time.monotonic() - began:7.1f} s  {text}"
    print(line, flush=True)
    with (FOLDER / "session.log").open("a", encoding="utf-8") as log:
        log.write(line + "\n")


def check(good: bool, text: str) -> None:
    say(("ok      " if good else "FAILED  ") + text)
    if not good:
        failures.append(text)


def picture(name: str) -> None:
    """Redraw, then take a picture of the screen."""
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    path = FOLDER / f"{name}.png"
    subprocess.run(["import", "-window", "root", str(path)], check=True)
    say(f"picture {path.name}")


def press(*names: str, pause: int = 100) -> None:
    """Press keys at the pointer, with pauses (ms)."""
    names = [_KEYCODES.get(name, name) for name in names]
    subprocess.run(["xdotool", "key", "--delay", str(pause), *names], check=True)


def keys(*names: str, over: str = "WINDOW") -> None:
    """Press keys with the mouse over the 3D view, or over its sidebar ("UI")."""
    place = next(region for region in view().regions if region.type == over)
    x = place.x + (200 if over == "WINDOW" else place.width // 2)
    height = bpy.context.window_manager.windows[0].height
    y = height - place.y - place.height // 4  # not in the middle, where reports are
    subprocess.run(["xdotool", "mousemove", str(x), str(y)], check=True)
    time.sleep(0.3)
    press(*names)


def view() -> bpy.types.Area:
    return next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == "VIEW_3D")


def here() -> dict[str, object]:
    """Return the position of a user's click in the 3D view."""
    window, area = bpy.context.window_manager.windows[0], view()
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region, "screen": window.screen}


def call(operator: Callable[..., set[str]], **options: object) -> set[str]:
    with bpy.context.temp_override(**here()):
        return operator("INVOKE_DEFAULT", **options)


def settings() -> bpy.types.PropertyGroup:
    return bpy.context.scene.firetwin


def busy() -> bool:
    return sys.modules[f"{MODULE}.ui.job"].Job.current is not None


def stopping() -> bool:
    job = sys.modules[f"{MODULE}.ui.job"].Job.current
    return job is None or job.stop.asked


def idle() -> bool:
    return not busy()


def tab() -> None:
    """Firetwin's tab of the sidebar, which is open and was drawn."""
    area = view()
    sidebar = next(region for region in area.regions if region.type == "UI")
    sidebar.active_panel_category = "Firetwin"


def built() -> list[str]:
    return [thing.name for thing in bpy.context.scene.objects if thing.name.startswith("Firetwin")]


def ready() -> Iterator[object]:
    """Open and build the small scene, unless it is built; its camera can be keyed by hand."""
    if built() and bpy.context.scene.camera is not None and "poses" in bpy.context.scene.camera.name:
        return
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    if not built():
        settings().scene_file = str(FOLDER / "scene.toml")
        yield 1
        yield idle
        call(bpy.ops.firetwin.build)
        yield 1
        yield idle
        yield 3
    check("Firetwin Ground" in built(), "the scene is built")
    view().spaces.active.region_3d.view_perspective = "PERSP"
    call(bpy.ops.firetwin.camera_add, kind="poses")
    yield 1
    yield idle
    yield 1


def key_frames() -> list[int]:
    """Return the frames in which the scene's camera has keys."""
    thing = bpy.context.scene.camera
    if thing is None or thing.animation_data is None or thing.animation_data.action is None:
        return []
    strips = [strip for layer in thing.animation_data.action.layers for strip in layer.strips]
    bags = [bag for strip in strips if (bag := strip.channelbag(thing.animation_data.action_slot))]
    points = (point for bag in bags for curve in bag.fcurves for point in curve.keyframe_points)
    return sorted({round(point.co.x) for point in points})


def soon(condition: Callable[[], bool], seconds: float = 300.0) -> Callable[[], bool]:
    """Yield a waiting time: a slow machine takes long to draw before it takes a key."""
    end = time.monotonic() + seconds
    return lambda: condition() or time.monotonic() > end


def ui() -> object:
    return sys.modules[f"{MODULE}.ui"]


def opened(cls: type, top: bool) -> type:
    """A panel like another one, but open: Blender keeps which are closed by their names."""
    own = {name: value for name, value in vars(cls).items() if name[:2] != "__" and name != "bl_rna"}
    own |= {"bl_idname": f"{cls.bl_idname}_open", "bl_options": set()}
    if top:
        own.pop("bl_parent_id", None)
    elif "bl_parent_id" in own:
        own["bl_parent_id"] += "_open"
    return type(own["bl_idname"], cls.__bases__, own)


def alone(top: str, take: Callable[[], None], *more: str) -> Iterator[object]:
    """Take a picture of one panel and those in it, open, with these before it."""
    panels = [each for each in ui().classes if issubclass(each, bpy.types.Panel)]
    names = {top, *more}
    shown = [
        opened(each, each.bl_idname == top)
        for each in panels
        if {each.bl_idname, getattr(each, "bl_parent_id", "")} & names
    ]
    for each in reversed(panels):
        bpy.utils.unregister_class(each)
    for each in shown:
        bpy.utils.register_class(each)
    yield 0.5
    tab()
    yield 2
    take()
    for each in reversed(shown):
        bpy.utils.unregister_class(each)
    for each in panels:
        bpy.utils.register_class(each)
    yield 0.5
    tab()
    yield 1
