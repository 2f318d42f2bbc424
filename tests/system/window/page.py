"""The artists' page, `docs/artists.md`, followed word by word, with its pictures.

Every button, menu entry and panel that the page names is in **bold**, and typed text is in `code`:
`Page.next` takes them in order, so that page and session cannot differ. Waiting times are in session.log.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
from hands import FOLDER, alone, built, call, check, here, idle, picture, say, settings, soon, tab, ui, view

PAGE = Path(__file__).parents[3] / "docs/artists.md"
_SIDEBAR, _WINDOW = "254x636+767+84", "1050x690+2+28"  # of the screen of 1280 x 800, with the usual sidebar


class Page:
    """Buttons and texts of the page, in order."""

    def __init__(self) -> None:
        text = PAGE.read_text(encoding="utf-8").partition("<!-- followed -->")[2]
        text = text.partition("<!-- end of followed -->")[0]
        self._left = [bold or code for bold, code in re.findall(r"\*\*(.+?)\*\*|`(.+?)`", text)]

    def next(self, *words: str) -> None:
        """These come next."""
        for word in words:
            found = self._left.pop(0) if self._left else "its end"
            check(found == word, f"the page says: {found}" + ("" if found == word else f", not {word}"))

    def over(self) -> None:
        """Nothing is left."""
        check(not self._left, f"the page is followed to its end {self._left or ''}")


def page_picture(name: str, part: str = _SIDEBAR) -> None:
    """A part of the screen, small enough for a page."""
    picture(f"40-{name}")
    out = FOLDER / "page" / f"{name}.png"
    out.parent.mkdir(exist_ok=True)
    small = ["-crop", part, "+repage", "-strip", "-dither", "None", "-colors", "128", f"PNG8:{out}"]
    subprocess.run(["convert", str(FOLDER / f"40-{name}.png"), *small], check=True)
    check(out.stat().st_size < 150_000, f"{out.name} has {out.stat().st_size / 1000:.0f} kB")


class Watch:
    """Seconds by the clock and by the processors, of Blender and of its finished child processes."""

    def __init__(self) -> None:
        self._clock, self._used = time.monotonic(), os.times()

    def say(self, what: str) -> None:
        """Write down the time since the beginning."""
        took, used = time.monotonic() - self._clock, sum(os.times()[:4]) - sum(self._used[:4])
        say(f"time    {what}: {took:.1f} s, {used:.1f} cpu-s")


def timed(what: str, start: Callable[[], object]) -> Iterator[object]:
    """Start some work and wait till it is over; how long it took is written down."""
    watch = Watch()
    start()
    yield 0.5
    yield idle
    watch.say(what)
    yield 1.5


def page() -> Iterator[object]:
    """From an installed add-on to a first own shot."""
    bpy.ops.wm.read_homefile()
    ui().queue.clear()  # what other steps rendered
    yield 3
    words, watch = Page(), Watch()
    yield from _opened(words)
    yield from _built(words)
    yield from _flown(words)
    yield from _rendered(words)
    yield from _changed(words)
    words.over()
    watch.say("the whole page")


def _opened(words: Page) -> Iterator[object]:
    words.next("N", "Firetwin")
    view().spaces.active.show_region_ui = True
    yield 2
    tab()
    yield 1
    page_picture("1-first")
    words.next("Try the King Fire")
    sample, again = bpy.ops.firetwin.sample, bpy.ops.firetwin.open
    yield from timed("Try the King Fire: write the sample run and read it", lambda: call(sample))
    check(settings().facts != "", "the made-up King Fire is open")
    path = str(Path(settings().run) / "run.toml")
    yield from timed("Open run, once it is there", lambda: call(again, filepath=path))
    page_picture("2-run")
    words.next(
        "Time", "Start", "2014-09-17 16:11:15-07:00", "End", "2014-09-17 16:11:45-07:00", "Frames", "24"
    )
    settings().time.frames = 24
    settings().time.start, settings().time.end = "2014-09-17 16:11:15-07:00", "2014-09-17 16:11:45-07:00"
    yield 1


def _built(words: Page) -> Iterator[object]:
    words.next("Scene", "Preview", "Build scene")
    call(bpy.ops.firetwin.quality, level="preview")
    yield 0.5
    yield from timed("Build scene at Preview, 24 frames, two cameras", lambda: call(bpy.ops.firetwin.build))
    watch = Watch()
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    watch.say("the built scene drawn in the 3D view")
    check("Firetwin Ground" in built(), "built")
    check(settings().changed == "", f"nothing changed since it was built {settings().changed}")
    yield 3
    page_picture("3-built", _WINDOW)


def _go(words: Page, place: str) -> Iterator[object]:
    words.next(place)
    settings().go_to = place
    call(bpy.ops.firetwin.go)
    region = view().spaces.active.region_3d
    where = sys.modules[f"{ui().__name__}.go_to"].find_position(bpy.context.scene, place)
    yield soon(lambda: (region.view_location - where).length < 1.0)
    yield 1
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)  # the key has the view that was drawn last
    check(region.view_perspective == "PERSP" and abs(region.view_distance - 2500.0) < 1.0, f"at {place}")


def _flown(words: Page) -> Iterator[object]:
    words.next("Cameras", "Camera by Hand")
    yield from _go(words, "38.965 -120.575")
    words.next("Add camera from view", "Poses", "Set key here")
    call(bpy.ops.firetwin.camera_add, kind="poses")
    yield 0.5
    yield idle
    yield 1
    call(bpy.ops.firetwin.camera_key)
    yield 1
    words.next("Time")
    settings().model_time = 1.0
    yield 1
    yield from _go(words, "38.975 -120.57")
    words.next("Set key here", "Look at", "Head of the fire")
    call(bpy.ops.firetwin.camera_key)
    yield 1
    call(bpy.ops.firetwin.camera_aim, target="head")
    yield 0.5
    yield idle
    yield 1
    check("cameras" in settings().changed.split(), f"changed since it was built: {settings().changed}")
    words.next("Build scene")
    yield from timed("Build scene again, three cameras", lambda: call(bpy.ops.firetwin.build))
    check(bpy.context.scene.camera.name == "Firetwin Camera poses", "the camera that was flown films")
    words.next("Through camera")
    call(bpy.ops.firetwin.view, whole=False)
    yield 3
    yield from alone("FIRETWIN_PT_cameras", lambda: page_picture("4-flown", _WINDOW))


def _rendered(words: Page) -> Iterator[object]:
    words.next("File > Save As", "my_shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "my_shot.blend"))
    yield 1
    words.next("Render", "Camera", "poses", "This frame", "Render in background")
    settings().camera, settings().which = "poses", "frame"
    yield from _background("the first picture, its depth and its thermal twin, in the background")
    yield from alone("FIRETWIN_PT_render", lambda: page_picture("5-rendered"))


def _background(what: str) -> Iterator[object]:
    queue, watch = sys.modules[f"{ui().__name__}.queue"], Watch()
    number = len(queue.items)
    call(bpy.ops.firetwin.render_background)
    yield 1

    def over() -> bool:
        return queue.items[number].state in ("done", "failed", "paused")

    yield soon(over, 900.0)
    watch.say(what)
    yield 2
    check(queue.items[number].state == "done", queue.items[number].text)


def _changed(words: Page) -> Iterator[object]:
    words.next("Light", "Haze", "0.3")
    settings().light.haze = 0.3
    yield 1
    check(settings().changed == "light", f"changed since it was built: {settings().changed}")
    yield from alone("FIRETWIN_PT_section_light", lambda: page_picture("6-changed"), "FIRETWIN_PT_build")
    yield from timed("Light again", lambda: call(bpy.ops.firetwin.build, part="light"))
    check(settings().changed == "", f"nothing is changed any more {settings().changed}")
    words.next("Render in background")
    yield from _background("the second picture")
    words.next("File > Save", "Export scene file", "my_shot.toml")
    bpy.ops.wm.save_mainfile()
    with bpy.context.temp_override(**here()):
        bpy.ops.firetwin.export("EXEC_DEFAULT", filepath=str(FOLDER / "my_shot.toml"))
    check((FOLDER / "my_shot.toml").exists(), "exported")
    yield 1
