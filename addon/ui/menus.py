"""Menu Firetwin in the header of the 3D view, and the pie menu.

The menus name every operator, so that F3 (Menu Search) finds it, for example as *Firetwin > Cameras > Set
camera key*.
"""

from __future__ import annotations

import bpy

from . import feature_panels, keys, manual, sections
from .menu_entries import Line, MenuEntry, Submenu

_OWN: dict[str, tuple[Line, ...]] = {
    "Run": (
        MenuEntry("open", "Open run...", "FILEBROWSER"),
        MenuEntry("sample", icon="LIGHT_SUN"),
        MenuEntry("inspect", icon="FILE_REFRESH"),
        MenuEntry("export", "Export scene file...", "EXPORT"),
        MenuEntry("run_add", icon="ADD"),
        MenuEntry("run_remove", "Remove first compared run", "REMOVE"),
    ),
    "Scene": (
        MenuEntry("build", icon="WORLD"),
        Submenu("FIRETWIN_MT_parts", "Rebuild parts"),
        MenuEntry("solve", icon="MOD_FLUIDSIM"),
        MenuEntry("smoke_volumes", "Write smoke of this frame", "OUTLINER_DATA_VOLUME", {"which": "frame"}),
        MenuEntry(
            "smoke_volumes", "Write smoke of playback range", "OUTLINER_DATA_VOLUME", {"which": "range"}
        ),
        MenuEntry("live", icon="SHADING_RENDERED"),
        MenuEntry("show_live", icon="SHADING_RENDERED"),
        MenuEntry("quality", "Set quality", choice="level"),
        MenuEntry("preset", icon="ADD"),
        Submenu("FIRETWIN_MT_presets", "Use saved preset"),
        Submenu("FIRETWIN_MT_reset", "Reset settings"),
        MenuEntry("view", "View through camera", "CAMERA_DATA", {"whole": False}),
        MenuEntry("view", "View whole run", "WORLD_DATA", {"whole": True}),
        MenuEntry("tiles_preview", icon="MESH_GRID"),
        MenuEntry("tiles_clear", icon="TRASH"),
        MenuEntry("assets", icon="ASSET_MANAGER"),
        MenuEntry("remove", icon="TRASH"),
    ),
    "Time": (
        Submenu("FIRETWIN_MT_moments", "Jump to event"),
        Submenu("FIRETWIN_MT_start", "Begin film at event"),
        Submenu("FIRETWIN_MT_end", "End film at event"),
    ),
    "Cameras": (
        MenuEntry("camera_add", "Add camera from view", "OUTLINER_OB_CAMERA", choice="kind"),
        MenuEntry("fly", "Walk with keys for the camera", "VIEW_PAN", {"mode": "walk"}),
        MenuEntry("fly", "Fly with keys for the camera", "ORIENTATION_GIMBAL", {"mode": "fly"}),
        MenuEntry("camera_key", icon="KEY_HLT"),
        MenuEntry("camera_aim", "Point camera at", "CON_TRACKTO", choice="target"),
        Submenu("FIRETWIN_MT_named", "Point camera at place"),
        MenuEntry("camera_path", icon="CON_FOLLOWPATH"),
        Submenu("FIRETWIN_MT_lenses", "Set lens and sensor"),
        MenuEntry("camera_copy", icon="DUPLICATE"),
        MenuEntry("camera_remove", icon="REMOVE"),
        MenuEntry("go", icon="FORWARD"),
        Submenu("FIRETWIN_MT_go", "Go to place of the run"),
        MenuEntry("vr_session", icon="VIEW3D"),
        Submenu("FIRETWIN_MT_vr_landmarks", "Start VR at landmark"),
        MenuEntry("vr_landmarks", icon="PMARKER_ACT"),
        MenuEntry("station_map", icon="IMAGE_DATA"),
        MenuEntry("station_pick", icon="EYEDROPPER"),
    ),
    "Render": (
        MenuEntry("output_preset", "Set output preset", choice="preset"),
        MenuEntry("render", "Render pictures and films", "RENDER_STILL"),
        MenuEntry("render_background", icon="RENDER_ANIMATION"),
        MenuEntry("queue", "Pause background render", "PAUSE", {"what": "pause"}),
        MenuEntry("queue", "Resume background render", "PLAY", {"what": "go_on"}),
        MenuEntry("queue", "Remove background render", "X", {"what": "remove"}),
        MenuEntry("regrade", "Add Firetwin Regrade to compositor...", "NODE_COMPOSITING"),
        MenuEntry("viewport_measure", icon="TIME"),
        MenuEntry("f12_files", "Let F12 write files", "OUTPUT", {"on": True}),
        MenuEntry("f12_files", "Stop F12 writing files", "OUTPUT", {"on": False}),
        MenuEntry("stop", icon="CANCEL"),
    ),
    "Help": (
        MenuEntry("help", "Open manual: first steps", "QUESTION", {"page": "artists"}),
        MenuEntry("help", "Open manual: settings", "QUESTION", {"page": "settings"}),
        MenuEntry("help", "Open manual: all pages", "QUESTION", {"page": "index"}),
        MenuEntry("copy", "Copy details of last message", "COPYDOWN"),
    ),
}
MENUS = {name: (*lines[:-1], *feature_panels.menu_lines(name), lines[-1]) for name, lines in _OWN.items()}
"""Lines of each submenu of the menu Firetwin; lines of features come before the last line."""

WITHOUT_ENTRY = {
    "convert": "Open run starts it",
    "queue_esc": "Render in background starts it",
    "vr_start_at": "the menu of landmarks calls it",
    "vr_play": "a controller calls it",
    "vr_time": "a controller calls it",
    "vr_landmark": "a controller calls it",
    "vr_turn": "a controller calls it",
    "vr_teleport": "a controller calls it",
}
"""Operators that only other operators call, and the reason."""

PIE = (
    MenuEntry("camera_key", icon="KEY_HLT"),
    MenuEntry("fly", "Walk", "VIEW_PAN", {"mode": "walk"}),
    MenuEntry("build", icon="WORLD"),
    MenuEntry("view", "Through camera", "CAMERA_DATA", {"whole": False}),
    MenuEntry("camera_add", "Add camera from view", "OUTLINER_OB_CAMERA", choice="kind"),
    MenuEntry("camera_aim", "Point camera at", "CON_TRACKTO", choice="target"),
    MenuEntry("render_background", icon="RENDER_ANIMATION"),
    Submenu("FIRETWIN_MT_go", "Go to place"),
)
"""Sectors of the pie menu, in Blender's order: left, right, below, above, then the corners."""


def entry_text(entry: MenuEntry) -> str:
    """Return the text of an entry: its own, else the name of its operator."""
    return entry.text or getattr(bpy.types, f"FIRETWIN_OT_{entry.operator}").bl_label


def _draw(layout: bpy.types.UILayout, lines: tuple[Line, ...]) -> None:
    for line in lines:
        if isinstance(line, Submenu):
            layout.menu(line.name, text=line.text)
        elif line.choice:
            layout.operator_menu_enum(
                f"firetwin.{line.operator}", line.choice, text=line.text, icon=line.icon
            )
        else:
            pressed = layout.operator(f"firetwin.{line.operator}", text=entry_text(line), icon=line.icon)
            for name, value in line.options.items():
                setattr(pressed, name, value)


def _create_menu(title: str, lines: tuple[Line, ...]) -> type[bpy.types.Menu]:
    def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
        self.layout.operator_context = "INVOKE_REGION_WIN"
        _draw(self.layout, lines)

    name = f"FIRETWIN_MT_main_{title.lower()}"
    own = {"__doc__": f"Firetwin: {title.lower()}", "bl_idname": name, "bl_label": title, "draw": draw}
    return type(name, (bpy.types.Menu,), own)


_SUBMENUS = tuple(_create_menu(title, lines) for title, lines in MENUS.items())


class FIRETWIN_MT_main(bpy.types.Menu):
    """All operators of Firetwin"""

    bl_idname = "FIRETWIN_MT_main"
    bl_label = "Firetwin"

    def draw(self, context: bpy.types.Context) -> None:
        for menu in _SUBMENUS:
            self.layout.menu(menu.bl_idname)


class FIRETWIN_MT_reset(bpy.types.Menu):
    """Reset all settings of a section to their defaults"""

    bl_idname = "FIRETWIN_MT_reset"
    bl_label = "Reset Settings"

    def draw(self, context: bpy.types.Context) -> None:
        for section in sections.sections():
            text = f"Reset {keys.section_title(section.name).lower()} settings"
            self.layout.operator("firetwin.reset", text=text).section = section.name


def _create_choice_menu(entry: MenuEntry) -> type[bpy.types.Menu]:
    def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
        self.layout.operator_context = "INVOKE_REGION_WIN"
        self.layout.operator_enum(f"firetwin.{entry.operator}", entry.choice)

    name = f"FIRETWIN_MT_choice_{entry.operator}"
    own = {"__doc__": entry.text, "bl_idname": name, "bl_label": entry.text, "draw": draw}
    return type(name, (bpy.types.Menu,), own)


_CHOICES = {
    line.operator: _create_choice_menu(line) for line in PIE if isinstance(line, MenuEntry) and line.choice
}
"""Menus of the pie's operators with a choice."""


class FIRETWIN_MT_pie(bpy.types.Menu):
    """Firetwin's operators for work with cameras"""

    bl_idname = "FIRETWIN_MT_pie"
    bl_label = "Firetwin"

    def draw(self, context: bpy.types.Context) -> None:
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_REGION_WIN"
        for line in PIE:
            name = pie_menu_name(line)
            if name:  # a submenu of a pie opens neither by its number nor by a click
                icon = line.icon if isinstance(line, MenuEntry) else "NONE"
                pie.operator("wm.call_menu", text=line.text, icon=icon).name = name
            else:
                _draw(pie, (line,))


def pie_menu_name(line: Line) -> str:
    """Return the name of the menu that a sector of the pie opens; empty: it calls an operator."""
    if isinstance(line, Submenu):
        return line.name
    return _CHOICES[line.operator].bl_idname if line.choice else ""


def _draw_header(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if context.mode == "OBJECT":
        self.layout.menu(FIRETWIN_MT_main.bl_idname)


def _draw_help(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(manual.FIRETWIN_OT_help.bl_idname, text="Firetwin Manual", icon="QUESTION")


_PLACES = (("VIEW3D_MT_editor_menus", _draw_header), ("TOPBAR_MT_help", _draw_help))


def register() -> None:
    """Add the menus to Blender's."""
    for name, draw in _PLACES:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Remove the menus from Blender's."""
    for name, draw in _PLACES:
        getattr(bpy.types, name).remove(draw)


classes = (*_SUBMENUS, *_CHOICES.values(), FIRETWIN_MT_main, FIRETWIN_MT_reset, FIRETWIN_MT_pie)
