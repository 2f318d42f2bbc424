"""The ways to an operator and its explanation: manual and pie menu.

For the pie menu, stand-ins replace the operators: they accept any context, do nothing, and record their
names. Pages of the manual are recorded in place of a browser.
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
from hands import MODULE, call, check, here, key_frames, keys, picture, ready, say, soon, tab, ui, view


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
    """Open the manual's page of every panel and operator, and one by a click on a help button."""
    pages, opened = sys.modules[f"{MODULE}.ui.manual"], []
    usual, webbrowser.open = webbrowser.open, lambda url, *_: opened.append(url) or True
    panels = [each for each in ui().classes if issubclass(each, bpy.types.Panel)]
    for each in panels:
        bpy.ops.firetwin.help(page=pages.topic(each.bl_idname))
    found = sum(map(_exists, opened))
    check(found == len(opened) == len(panels), f"{found} of {len(panels)} panels have a page of the manual")
    opened.clear()
    names = [each.bl_idname for each in ui().classes if issubclass(each, bpy.types.Operator)]
    for name in names:
        bpy.ops.wm.doc_view_manual(doc_id=name)
    found = sum(map(_exists, opened))
    check(found == len(opened) == len(names), f"{found} of {len(names)} operators have a page of the manual")
    view().spaces.active.show_region_ui = True
    yield 1
    tab()
    yield 2
    sidebar = next(region for region in view().regions if region.type == "UI")
    top = bpy.context.window_manager.windows[0].height - sidebar.y - sidebar.height
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


def pie() -> Iterator[object]:
    """Call the operators of the pie menu by their numbers; the one for camera keys sets a key."""
    yield from ready()
    menus, failed = sys.modules[f"{MODULE}.ui.menus"], []
    with StandIns() as stand_ins:
        for line, number in zip(menus.PIE, "46287913", strict=True):
            if isinstance(line, menus.Submenu) or line.choice:  # a number opens no menu
                continue
            stand_ins.called.clear()
            keys("ctrl+alt+f")
            yield 1
            if number == "4":
                picture("52-pie-opening")
                yield 2
                picture("52-pie")
            keys(number)
            yield 0.7
            yield soon(lambda: bool(stand_ins.called), 3.0)
            keys("Escape")
            yield 0.3
            if stand_ins.called != [line.operator]:
                failed.append(f"{line.operator}: {stand_ins.called}")
    check(not failed, f"the pie menu calls its operators {failed or ''}")
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
