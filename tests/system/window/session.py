"""A session in Blender's window, as a user would have it: ``blender --python session.py -- FOLDER STEP...``.

FOLDER holds firetwin.zip, scene.toml, broken.toml and plain.toml; pictures of the screen, files of the
session and session.log are written there. The steps are a generator that a timer takes further: it yields
seconds to wait, or a function to wait for. Exit status 0 when everything was as it should be.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
import traceback
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import allocating
import customized
import found
import headset
import inventory
import page
import shown
import tile_preview
from hands import (
    FOLDER,
    MODULE,
    PATIENCE,
    STEPS,
    alone,
    built,
    busy,
    call,
    check,
    failures,
    here,
    idle,
    keys,
    picture,
    say,
    settings,
    soon,
    stopping,
    tab,
    view,
)

USER = Path(os.environ["BLENDER_USER_RESOURCES"])


def install() -> Iterator[object]:
    bpy.ops.screen.userpref_show(section="EXTENSIONS")
    yield 1
    subprocess.run(["xdotool", "search", "--name", "Preferences", "windowmove", "100", "60"], check=False)
    yield 1
    window = bpy.context.window_manager.windows[-1]
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        done = bpy.ops.extensions.package_install_files(
            filepath=str(FOLDER / "firetwin.zip"), repo="user_default", enable_on_install=True
        )
    check(done == {"FINISHED"}, "installed from disk")
    check(MODULE in bpy.context.preferences.addons, "enabled")
    yield 2
    picture("02-installed")
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.window_close()
    yield 1


def panel() -> Iterator[object]:
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    yield 1
    picture("03-panel")
    check(not bpy.ops.firetwin.build.poll(), "Build scene waits for a run")
    settings().scene_file = str(FOLDER / "broken.toml")
    yield 1
    yield idle
    yield 2
    check("broken.toml:2:" in settings().problem, f"a broken scene file: {settings().problem}")
    picture("04-broken-scene-file")
    keys("Escape")  # closes the report, which would take the next keys
    yield 2
    settings().scene_file = str(FOLDER / "scene.toml")
    yield 0.5
    yield idle
    yield 3
    check(settings().facts != "", "the run is known")
    check(settings().run.endswith("sample"), f"the scene file's run is shown: {settings().run}")
    picture("05-run")


def quality() -> Iterator[object]:
    """A step of quality, a setting and its mark; the exported file brings the same back."""
    before = settings().render.samples
    call(bpy.ops.firetwin.quality, level="final")
    yield 1
    check(settings().render.samples == 24, f"samples {before} -> {settings().render.samples}")
    with bpy.context.temp_override(**here()):
        bpy.ops.firetwin.export("EXEC_DEFAULT", filepath=str(FOLDER / "exported.toml"))
    call(bpy.ops.firetwin.reset, section="render", key="samples")
    yield 1
    call(bpy.ops.firetwin.open, filepath=str(FOLDER / "exported.toml"))
    yield 1
    yield idle
    check(settings().render.samples == 24, "the exported scene file brings it back")
    settings().scene_file = str(FOLDER / "scene.toml")
    yield 1
    yield idle
    yield 1


def build() -> Iterator[object]:
    names = sorted(thing.name for thing in bpy.context.scene.objects)
    check(names == ["Camera", "Cube", "Light"], f"the startup scene: {', '.join(names)}")
    call(bpy.ops.firetwin.build)
    yield 6
    check(busy(), "building runs in the background")
    picture("06-building")
    yield idle
    yield 5
    check("Firetwin Ground" in built() and "Firetwin Smoke" in built(), f"built {len(built())} objects")
    check(len(bpy.data.scenes) == 1, "into the startup scene, which nobody used")
    check(view().spaces.active.clip_end > 100_000, "the view reaches as far as the scene")
    picture("07-built")


def uid(name: str) -> int:
    """Return the identity of the object with this name; 0: none."""
    thing = bpy.context.scene.objects.get(name)
    return thing.session_uid if thing else 0


def parts() -> Iterator[object]:
    """A part again, then everything away; each is undone."""
    bpy.context.scene.camera.name = "Mine"
    bpy.ops.ed.undo_push(message="Rename")
    before = {name: uid(name) for name in ("Mine", "Firetwin Ground", "Firetwin Trees")}
    call(bpy.ops.firetwin.build, part="forest")
    yield 1
    yield idle
    yield 3
    after = {name: uid(name) for name in before}
    same = [name for name in before if before[name] == after[name]]
    check(
        same == ["Mine", "Firetwin Ground"] and after["Firetwin Trees"] != 0, f"the forest again, not {same}"
    )
    check(bpy.context.scene.camera.name == "Mine", "a renamed camera stays")
    picture("07-forest-again")
    keys("ctrl+z")

    def undone() -> bool:
        return all(map(uid, before)) and uid("Firetwin Trees") != after["Firetwin Trees"]

    yield soon(undone)
    check(undone(), "undo brings the first forest back")
    with bpy.context.temp_override(**here()):
        bpy.ops.firetwin.remove("EXEC_DEFAULT", True)
    yield 3
    check(not built() and "Mine" not in bpy.context.scene.objects, "removed")
    check(view().spaces.active.clip_end < 2000, "the view has its own clipping again")
    picture("07-removed")
    keys("ctrl+z")
    yield soon(lambda: all(map(uid, before)))
    yield 1
    check(all(map(uid, before)), "undo brings the scene back")
    bpy.context.scene.camera.name = "Firetwin Camera drone"
    call(bpy.ops.firetwin.view, whole=False)
    yield 2


def look() -> Iterator[object]:
    """Solid view, material preview and the ground's nodes."""
    shading = view().spaces.active.shading
    check(shading.color_type == "VERTEX", f"the solid view shows the colours of meshes: {shading.color_type}")
    for name, whole, kind, seconds in (
        ("whole", True, "SOLID", 4),
        ("camera", False, "SOLID", 4),
        ("camera", False, "MATERIAL", 90),  # without a GPU, compiling the shaders takes this long
    ):
        call(bpy.ops.firetwin.view, whole=whole)
        shading.type = kind
        yield seconds
        picture(f"19-{name}-{kind.lower()}")
    shading.type = "SOLID"
    ground = bpy.context.scene.objects["Firetwin Ground"]
    bpy.context.view_layer.objects.active = ground
    area = view()
    area.ui_type = "ShaderNodeTree"
    yield 2
    picture("19-material-nodes")
    group = next(node for node in ground.active_material.node_tree.nodes if node.type == "GROUP")
    area.spaces.active.path.append(group.node_tree, node=group)
    yield 2
    region = next(region for region in area.regions if region.type == "WINDOW")
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.node.view_all()
    yield 2
    picture("19-ground-nodes")
    area.ui_type = "VIEW_3D"
    call(bpy.ops.firetwin.view, whole=False)
    yield 2


def scrub() -> Iterator[object]:
    settings().model_time = 1.0
    yield 4
    check(bpy.context.scene.frame_current == bpy.context.scene.frame_end, "scrubbed to the last frame")
    picture("08-scrubbed")
    call(bpy.ops.firetwin.view, whole=True)
    yield 4
    picture("09-whole-run")
    call(bpy.ops.firetwin.view, whole=False)
    settings().model_time = 0.5
    yield 3


def render() -> Iterator[object]:
    """Debian builds Cycles without NanoVDB: it draws no volume grid, not even Blender's own. EEVEE does."""
    settings().output = str(FOLDER / "pictures")
    settings().render.engine, settings().render.passes = "eevee", {"rgb"}
    call(bpy.ops.firetwin.render)
    yield 5
    picture("10-rendering")
    yield idle
    yield 2
    frame = bpy.context.scene.frame_current
    smoky = FOLDER / f"pictures/drone/rgb/drone_rgb_{frame:06d}.exr"
    check(smoky.exists(), f"rendered {smoky.name}")
    picture("11-rendered")
    settings().scene_file, settings().output = str(FOLDER / "plain.toml"), str(FOLDER / "plain")
    yield 0.5
    yield idle
    settings().render.engine, settings().render.passes = "eevee", {"rgb"}
    call(bpy.ops.firetwin.render)
    yield 1
    yield idle
    clear = FOLDER / f"plain/drone/rgb/drone_rgb_{frame:06d}.exr"
    difference = mean_difference(smoky, clear)
    check(difference > 0.01, f"smoke changes the picture: mean difference {difference:.4f} (scene-linear)")
    settings().scene_file, settings().output = str(FOLDER / "scene.toml"), str(FOLDER / "stopped")
    yield 0.5
    yield idle
    settings().render.engine = "eevee"
    call(bpy.ops.firetwin.render)
    yield 8
    check(busy(), "rendering again")
    keys("Escape")
    yield 2
    check(busy() and not stopping(), "Esc over the 3D view belongs to something else")
    keys("Escape", over="UI")
    yield stopping
    asked = time.monotonic()
    yield idle
    check(
        time.monotonic() - asked < 60,
        f"Esc over the sidebar stops it, {time.monotonic() - asked:.1f} s later",
    )
    check(not list((FOLDER / "stopped").rglob(".part-*")), "a stopped render leaves nothing half made")
    yield 1
    picture("12-stopped")


def mean_difference(one: Path, other: Path) -> float:
    import numpy as np

    pixels = []
    for path in (one, other):
        image = bpy.data.images.load(str(path))
        pixels.append(np.array(image.pixels[:]))
        bpy.data.images.remove(image)
    return float(np.abs(pixels[0] - pixels[1]).mean())


def by_hand() -> Iterator[object]:
    """A camera from the view, keyed by flying, preserved by a rebuild, and rendered in the background."""
    region, queue = view().spaces.active.region_3d, sys.modules[f"{MODULE}.ui.queue"]
    call(bpy.ops.firetwin.view, whole=False)
    yield 2
    region.view_perspective = "PERSP"
    call(bpy.ops.firetwin.camera_add, kind="poses")
    yield 1
    yield idle
    yield 2
    thing = bpy.context.scene.camera
    check(thing.name == "Firetwin Camera poses", f"a camera from the view: {thing.name}")
    call(bpy.ops.firetwin.camera_key)
    with bpy.context.temp_override(**here()):
        bpy.ops.firetwin.go("EXEC_DEFAULT", text="camera drone", smooth=False)
    bpy.context.scene.frame_set(bpy.context.scene.frame_end)
    yield 2
    call(bpy.ops.firetwin.camera_key)
    yield 1
    yield from alone("FIRETWIN_PT_cameras", lambda: picture("30-keyed-by-hand"))
    thing.name = "My flight"
    call(bpy.ops.firetwin.build, part="cameras")
    yield 1
    yield idle
    yield 2
    check(bpy.context.scene.objects.get("My flight") == thing, "a renamed and keyed camera stays itself")
    settings().output, settings().which = str(FOLDER / "beside"), "all"
    settings().camera = "My-flight"
    bpy.context.scene.cycles.samples = 1000  # it must not be done before it is paused
    call(bpy.ops.firetwin.render_background)
    yield 8
    check(queue.current() is not None, "a render runs in the background")
    call(bpy.ops.firetwin.render_background)
    yield 2
    yield from alone("FIRETWIN_PT_render", lambda: picture("31-queue"))
    keys("Escape")
    yield 2
    check(not queue.items[0].stop.asked, "Esc over the 3D view belongs to something else")
    keys("Escape", over="UI")

    def paused() -> list[int]:
        return [index for index, item in enumerate(queue.items) if item.state == "paused"]

    yield soon(lambda: bool(paused()))
    check(bool(paused()), "Esc over the sidebar pauses the current render")
    for index in paused():
        call(bpy.ops.firetwin.queue, index=index, what="go_on")
    yield soon(lambda: all(item.state in ("done", "failed") for item in queue.items), 900.0)
    yield 2
    check([item.state for item in queue.items] == ["done", "done"], str([item.text for item in queue.items]))
    yield from alone("FIRETWIN_PT_render", lambda: picture("32-queue-done"))
    bpy.context.scene.cycles.samples = 1


def undo() -> Iterator[object]:
    for _ in range(20):
        if not built():
            break
        keys("ctrl+z")
        yield 4
    check(not built(), "undo takes the scene back")
    check("Cube" in bpy.context.scene.objects, "undo brings the startup cube back")
    check(bpy.context.scene.world is not None, "and its world")
    picture("13-undone")
    for _ in range(20):
        if built():
            break
        keys("ctrl+shift+z")
        yield 4
    check("Firetwin Ground" in built(), "redo builds it again")
    picture("14-redone")


def beside() -> Iterator[object]:
    """Somebody's scene stays as it is: a new one is made, shown, and undone."""
    window, path = bpy.context.window_manager.windows[0], settings().scene_file
    before = window.scene.name
    with bpy.context.temp_override(**here()):
        bpy.ops.scene.new(type="NEW")
    mine = window.scene
    mine.name = "Somebody's"
    mine.collection.objects.link(bpy.data.objects.new("Theirs", None))
    mine.firetwin.scene_file = path
    yield 1
    yield idle
    bpy.ops.ed.undo_push(message="Somebody's scene")
    call(bpy.ops.firetwin.build)
    yield 1
    yield idle
    yield 4
    check(window.scene.name.startswith("Firetwin") and built() != [], f"built into {window.scene.name}")
    check(bpy.data.scenes["Somebody's"].objects.keys() == ["Theirs"], "somebody's scene stays as it is")
    picture("14-beside")
    keys("ctrl+z")

    def names() -> list[str]:
        return [scene.name for scene in bpy.data.scenes]

    yield soon(lambda: not any(name.startswith("Firetwin") for name in names()))
    yield 1
    left = names()
    check(not any(name.startswith("Firetwin") for name in left), f"undo takes it back, and leaves {left}")
    check(window.scene.name == "Somebody's", f"the window shows {window.scene.name}")
    with bpy.context.temp_override(**here()):
        bpy.ops.scene.delete()
    window.scene = bpy.data.scenes[before]
    yield 2


def file() -> Iterator[object]:
    path = FOLDER / "saved.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    yield 1
    bpy.ops.wm.open_mainfile(filepath=str(path))
    yield 5
    check("Firetwin Ground" in built(), "saved and opened again")
    check(settings().facts != "" and settings().first_time != "", "the panel remembers")
    tab()
    yield 3
    picture("15-opened-again")


def leave(before: dict[str, list[str]]) -> Iterator[object]:
    bpy.ops.preferences.addon_disable(module=MODULE)
    yield 2
    check(not hasattr(bpy.types.Scene, "firetwin"), "disabled")
    remains = [
        name
        for name in inventory.left(before, inventory.take(USER))
        if not name.startswith(("files", "search"))
    ]
    check(not remains, f"disabling leaves nothing registered {remains or ''}")
    names = [each.name for each in bpy.context.preferences.filepaths.asset_libraries]
    check("Firetwin" not in names, f"and leaves the asset libraries of the user: {names}")
    picture("16-disabled")
    bpy.ops.preferences.addon_enable(module=MODULE)
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    yield 2
    check(hasattr(bpy.types.Scene, "firetwin"), "enabled again")
    picture("17-enabled-again")
    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.module == "user_default")
    done = bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="firetwin")
    yield 3
    check(done == {"FINISHED"}, "uninstalled")
    remains = inventory.left(before, inventory.take(USER))
    check(not remains, f"uninstalling leaves nothing behind {remains or ''}")
    picture("18-uninstalled")


def session() -> Iterator[object]:
    say(f"Blender {bpy.app.version_string}, Python {sys.version.split()[0]}")
    yield 3
    before = inventory.take(USER)
    picture("01-start")
    yield from install()
    for step in (
        *(panel, quality, build, shown.sections, shown.dialogs, look, parts, scrub, render),
        *(by_hand, undo),  # undo reaches back to the build, before steps that add cameras
        *(found.manual, found.find, found.pie, customized.shortcuts, customized.german),
        *(customized.preferences, customized.assets, allocating.allocate),
        *(beside, file, shown.drop, tile_preview.tiles, page.page),
        *(customized.cache, headset.headset),
    ):
        if step.__name__ in STEPS:
            yield from step()
    yield from leave(before)


def end(code: int) -> None:
    say(f"{len(failures)} failed" if failures else "all as it should be")
    sys.stdout.flush()
    os._exit(code)


class Clock:
    def __init__(self) -> None:
        self.steps, self.waiting, self.since = session(), None, 0.0

    def __call__(self) -> float:
        try:
            if self.waiting is not None and not self.waiting():
                if time.monotonic() - self.since > PATIENCE:
                    raise TimeoutError("nothing happens any more")
                return 0.3
            step = next(self.steps)
        except StopIteration:
            end(1 if failures else 0)
        except BaseException:
            say(traceback.format_exc())
            picture("99-failed")
            failures.append("the session did not come to its end")
            end(1)
        self.waiting, self.since = (step, time.monotonic()) if callable(step) else (None, 0.0)
        return 0.3 if callable(step) else float(step)


bpy.app.timers.register(Clock(), first_interval=2.0, persistent=True)
