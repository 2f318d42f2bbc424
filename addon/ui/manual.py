"""Online manual: the page of each panel, operator and setting, for right-click > Online Manual and Help.

If the extension's manifest names a website, links lead to its pages; otherwise to HTML files written
from the installed documentation into Firetwin's folder.
"""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path

import bpy

from . import manual_pages, scene_file, sections, working

_PANELS = {
    "run": "artists#1-open-a-fire",
    "facts": "artists#1-open-a-fire",
    "other_runs": "pipelines#several-runs-of-one-fire",
    "build": "artists#2-choose-the-time-and-build",
    "time": "artists#2-choose-the-time-and-build",
    "cameras": "passes_and_cameras#cameras",
    "flying": "artists#3-fly-your-own-camera",
    "vr": "vr",
    "viewport": "vr#viewport",
    "render": "artists#4-render-in-the-background",
    "queue": "artists#4-render-in-the-background",
    "farm": "farm",
    "story": "story#in-blender",
    "stations": "stations#in-blender",
    "station_map": "stations#in-blender",
    "allocation": "stations#a-suggested-allocation",
    "export": "export",
    "tiles": "tiles#in-blenders-window",
    "report": "artists#next-steps",
}
_OPERATORS = {
    "open": "runs#runs-of-other-fire-models",
    "convert": "runs#runs-of-other-fire-models",
    "sample": "artists#1-open-a-fire",
    "inspect": "artists#1-open-a-fire",
    "export": "artists#6-keep-it",
    "export_to": "export",
    "run_*": "pipelines#several-runs-of-one-fire",
    "build": "artists#2-choose-the-time-and-build",
    "remove": "artists#2-choose-the-time-and-build",
    "quality": "artists#next-steps",
    "preset": "artists#next-steps",
    "view": "artists#2-choose-the-time-and-build",
    "reset": "artists#5-change-something",
    "stop": "artists#2-choose-the-time-and-build",
    "copy": "artists#next-steps",
    "solve": "how/smoke",
    "live": "vr#the-live-scene",
    "show_live": "vr#the-live-scene",
    "smoke_volumes": "pipelines#smoke-in-blend-files",
    "jump": "artists#2-choose-the-time-and-build",
    "window": "artists#2-choose-the-time-and-build",
    "camera_*": "artists#3-fly-your-own-camera",
    "fly": "artists#3-fly-your-own-camera",
    "go": "artists#next-steps",
    "vr_*": "vr",
    "viewport_measure": "vr#viewport",
    "assets": "artists#menus-keys-and-preferences",
    "help": "artists#menus-keys-and-preferences",
    "output_preset": "artists#compositing-and-editing",
    "render": "pipelines#a-film-of-a-run",
    "render_background": "artists#4-render-in-the-background",
    "f12_files": "artists#4-render-in-the-background",
    "regrade": "delivery#regrading-in-blender",
    "queue*": "artists#4-render-in-the-background",
    "farm_*": "farm",
    "story_*": "story#in-blender",
    "station_*": "stations#in-blender",
    "allocate": "stations#a-suggested-allocation",
    "tiles_*": "tiles#in-blenders-window",
}


def topic(panel: str) -> str:
    """Return page and heading of a panel, by its `bl_idname`."""
    name = panel.removeprefix("FIRETWIN_PT_")
    return _PANELS.get(name) or f"settings#{name.removeprefix('section_')}"


def address(page: str) -> str:
    """Return the URL of a page, with or without ``#heading``."""
    return _prefix() + _suffix(page)


def manual_map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Return the prefix of the manual's URLs, and the page of each identifier (`bpy.utils.manual_map`)."""
    named = [(f"bpy.ops.firetwin.{name}", page) for name, page in _OPERATORS.items()]
    groups = "bpy.types.firetwin_pg_"
    settings = [
        (f"{groups}{part.table.__name__.lower()}.*", f"settings#{part.name}")
        for part in sections.sections()
        if part.table is not None
    ]
    rest = [(f"{groups}*", "settings"), ("bpy.types.firetwin_*", "artists")]
    return _prefix(), tuple((pattern, _suffix(page)) for pattern, page in (*named, *settings, *rest))


@functools.cache
def website() -> str:
    """Return the website of the extension's manifest; empty without one."""
    path = Path(__file__).resolve().parents[1] / "blender_manifest.toml"
    try:
        return str(tomllib.loads(path.read_text(encoding="utf-8")).get("website", "")).rstrip("/")
    except (OSError, tomllib.TOMLDecodeError):
        return ""


@functools.cache
def _local_folder() -> Path:
    """Write the pages once per session, and return their folder."""
    out = scene_file.own_folder() / "manual"
    if (pages := manual_pages.source()) is not None:
        manual_pages.write(pages, out)
    return out


def _prefix() -> str:
    return f"{website()}/" if website() else f"{_local_folder().as_uri()}/"


def _suffix(page: str) -> str:
    """Return the end of a URL: ``farm/#slurm`` of the website, ``farm.html#slurm`` of local files."""
    name, _, heading = page.partition("#")
    end = f"{name}/" if website() else f"{name}.html"
    return f"{end}#{heading}" if heading else end


class FIRETWIN_OT_help(bpy.types.Operator):
    """Open the manual of Firetwin in the browser, at this panel"""

    bl_idname = "firetwin.help"
    bl_label = "Open manual"

    page: bpy.props.StringProperty(
        name="Page", description="Page and heading of the manual", default="artists", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not website() and manual_pages.source() is None:
            cls.poll_message_set("This installation has no manual: install Firetwin again")
            return False
        return True

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        context.window_manager  # noqa: B018
        bpy.ops.wm.url_open(url=address(self.page))
        return {"FINISHED"}


def draw_button(layout: bpy.types.UILayout, panel: str) -> None:
    """Draw the help button of a panel."""
    pressed = layout.operator(FIRETWIN_OT_help.bl_idname, text="", icon="QUESTION", emboss=False)
    pressed.page = topic(panel)


def register() -> None:
    """Add the manual to Blender's Online Manual."""
    bpy.utils.register_manual_map(manual_map)


def unregister() -> None:
    """Remove the manual from Blender's Online Manual."""
    bpy.utils.unregister_manual_map(manual_map)


classes = (FIRETWIN_OT_help,)
