"""The ways to an operator and its explanation: manual, search and pie menu.

For search and pie menu, stand-ins replace the operators: they accept any context, do nothing, and record
their names. Pages of the manual are recorded in place of a browser.
"""

from __future__ import annotations

import subprocess
import sys
import urllib.parse
import webbrowser
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType

import bpy
from hands import (
    FOLDER,
    MODULE,
    built,
    call,
    check,
    here,
    idle,
    key_frames,
    keys,
    picture,
    press,
    ready,
    say,
    settings,
    soon,
    tab,
    ui,
    view,
)

_INSIDE = {
    "FIRETWIN_MT_parts": "build",
    "FIRETWIN_MT_reset": "reset",
    "FIRETWIN_MT_moments": "jump",
    "FIRETWIN_MT_start": "window",
    "FIRETWIN_MT_end": "window",
    "FIRETWIN_MT_named": "camera_aim",
    "FIRETWIN_MT_lenses": "camera_lens",
    "FIRETWIN_MT_go": "go",
}
"""Menus of other modules, and the operator of their lines; saved presets are Blender's operator."""


class StandIns:
    """Stand-ins for all operators of the add-on, until the end of a `with` block."""

    def __init__(self) -> None:
        self.called: list[str] = []
        self._usual: list[tuple[type, str, object]] = []

    def __enter__(self) -> StandIns:
        for cls in (each for each in ui().classes if issubclass(each, bpy.types.Operator)):
            stand_ins = {"poll": classmethod(lambda cls, context: True)}
            stand_ins |= dict.fromkeys(("execute", "invoke"), self._recorder(cls))
            for name, function in stand_ins.items():
                if any(name in vars(base) for base in cls.__mro__):
                    self._usual.append((cls, name, vars(cls).get(name)))
                    setattr(cls, name, function)
        return self

    def _recorder(self, cls: type) -> Callable[..., set[str]]:
        def record(operator: bpy.types.Operator, *_: object) -> set[str]:
            self.called.append(cls.bl_idname.removeprefix("firetwin."))
            return {"FINISHED"}

        return record

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        for cls, name, function in self._usual:
            if function is None:  # inherited
                delattr(cls, name)
            else:
                setattr(cls, name, function)


def manual() -> Iterator[object]:
    """Open the manual's page of every panel and operator, by F1 over buttons, and by a help button."""
    pages, opened = sys.modules[f"{MODULE}.ui.manual"], []
    usual, webbrowser.open = webbrowser.open, lambda url, *_: opened.append(url) or True
    panels = [each for each in ui().classes if issubclass(each, bpy.types.Panel)]
    for each in panels:
        bpy.ops.firetwin.help(page=pages.topic(each.bl_idname))
    documented = sum(map(_exists, opened))
    check(
        documented == len(opened) == len(panels),
        f"{documented} of {len(panels)} panels have a page of the manual",
    )
    opened.clear()
    names = [each.bl_idname for each in ui().classes if issubclass(each, bpy.types.Operator)]
    for name in names:
        bpy.ops.wm.doc_view_manual(doc_id=name)
    documented = sum(map(_exists, opened))
    check(
        documented == len(opened) == len(names),
        f"{documented} of {len(names)} operators have a page of the manual",
    )
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    yield 2
    sidebar = next(region for region in view().regions if region.type == "UI")
    top = bpy.context.window_manager.windows[0].height - sidebar.y - sidebar.height
    opened.clear()
    for down in range(30, 350, 40):
        _point(sidebar.x + sidebar.width // 2, top + down)
        yield 0.3
        press("F1")
        yield 0.5
    ours = {url.rpartition("/")[2] for url in opened if url.startswith("file:") and _exists(url)}
    check(bool(ours), f"F1 over the sidebar's buttons opens {', '.join(sorted(ours))}")
    opened.clear()
    for left in range(24, 72, 6):
        _point(sidebar.x + sidebar.width - left, top + 16)
        yield 0.3
        subprocess.run(["xdotool", "click", "1"], check=True)
        yield 0.7
        if opened:
            break
    ours = [url.rpartition("/")[2] for url in opened]
    check(bool(ours) and _exists(opened[0]), f"a click on the first panel's question mark opens {ours}")
    picture("50-help-button")
    webbrowser.open = usual


def _exists(url: str) -> bool:
    """Return whether a page of the manual on this disk has this heading."""
    parts = urllib.parse.urlparse(url)
    path = Path(urllib.parse.unquote(parts.path))
    if parts.scheme != "file" or not path.is_file():
        say(f"not a page of the manual: {url}")
        return False
    return not parts.fragment or f'id="{parts.fragment}"' in path.read_text("utf-8")


def _point(x: int, y: int) -> None:
    subprocess.run(["xdotool", "mousemove", str(x), str(y)], check=True)


def find() -> Iterator[object]:
    """Type the full name of every menu entry after F3, and press Return."""
    view().spaces.active.show_region_ui = True
    if not settings().run:
        settings().run = str(FOLDER / "sample")
        yield 1
        yield idle
    menus = sys.modules[f"{MODULE}.ui.menus"]
    keys("F3")  # the pointer stays over the 3D view
    yield 0.5
    press("Escape")
    yield 0.3
    operators, failed = set(), []
    with StandIns() as stand_ins:
        yield from _search(stand_ins, "firetwin cameras set camera quay")
        check(not stand_ins.called, f"F3 finds no operator of another name {stand_ins.called or ''}")
        for words, operator in _entries(menus):
            yield from _search(stand_ins, words, "51-search" if operator == "camera_key" else "")
            if stand_ins.called == [operator]:
                operators.add(operator)
            else:
                failed.append(f"{words}: {stand_ins.called}")
    every = {each.bl_idname for each in ui().classes if issubclass(each, bpy.types.Operator)}
    wanted = {each.removeprefix("firetwin.") for each in every} - set(menus.WITHOUT_ENTRY)
    check(not failed, f"F3 finds every entry by its full name {failed or ''}")
    check(
        operators == wanted,
        f"F3 finds {len(operators)} of {len(wanted)} operators {sorted(wanted - operators) or ''}",
    )


def _entries(menus: object) -> Iterator[tuple[str, str]]:
    """Yield the text to type after F3, and the operator, of every entry of the menu Firetwin."""
    for title, lines in menus.MENUS.items():
        for line in lines:
            own = isinstance(line, menus.MenuEntry)
            operator = line.operator if own else _INSIDE.get(line.name)
            if operator is not None:
                text = menus.entry_text(line) if own else line.text
                if operator == "build" and not own:
                    text += " rebuild"  # the menu also has Remove all parts
                yield f"firetwin {title} {text}".lower().rstrip("."), operator


def _search(stand_ins: StandIns, words: str, name: str = "") -> Iterator[object]:
    """Search for a text, and choose the first result; take a picture of this name."""
    stand_ins.called.clear()
    bpy.context.window_manager.clipboard = words
    press("F3")
    yield 0.4
    press("ctrl+v")
    yield 0.3
    if name:
        picture(name)
    press("Return")
    yield soon(lambda: bool(stand_ins.called), 1.0)
    press("Escape")
    yield 0.1


def pie() -> Iterator[object]:
    """Call the operators of the pie menu by their numbers; the one for camera keys sets a key."""
    yield from ready()
    menus, failed = sys.modules[f"{MODULE}.ui.menus"], []
    for name in built():  # drawn slowly without a GPU
        bpy.context.scene.objects[name].hide_set(True)
    bpy.context.preferences.view.pie_animation_timeout = 0
    with StandIns() as stand_ins:
        for line, number in zip(menus.PIE, "46287913", strict=True):
            menu = menus.pie_menu_name(line)
            operator = line.operator if isinstance(line, menus.MenuEntry) else _INSIDE[line.name]
            stand_ins.called.clear()
            keys("ctrl+alt+f")
            yield 1
            if number == "4":
                picture("52-pie")
            press(number)
            yield 1
            if menu:
                picture(f"52-pie-{operator}")
                press("Down", "Return")
            yield soon(lambda: bool(stand_ins.called), 3.0)
            press("Escape")
            yield 0.3
            if stand_ins.called != [operator]:
                failed.append(f"{operator}: {stand_ins.called}")
    check(not failed, f"the pie menu calls its {len(menus.PIE)} operators {failed or ''}")
    for name in built():
        bpy.context.scene.objects[name].hide_set(False)
    call(bpy.ops.firetwin.view, whole=True)
    with bpy.context.temp_override(**here()):
        bpy.context.space_data.region_3d.view_perspective = "PERSP"
    bpy.context.scene.frame_set(2)
    yield 1
    keys("ctrl+alt+f")
    yield 1
    keys("4")
    yield soon(lambda: 2 in key_frames(), 20.0)
    check(2 in key_frames(), f"Set camera key of the pie menu sets a key: {key_frames()}")
