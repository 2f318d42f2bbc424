"""Operators of the add-on: name in F3, help link and key. As a script it prints the table."""

from fnmatch import fnmatchcase

import bpy
from firetwin import ui
from firetwin.ui import keymap, manual, menus

SUBMENUS = {
    "camera_lens": "FIRETWIN_MT_lenses",
    "jump": "FIRETWIN_MT_moments",
    "reset": "FIRETWIN_MT_reset",
    "window": "FIRETWIN_MT_start",
}
"""Operators with choices of the run or the user, and the menu that lists them."""


def operators():
    """Operator classes by name, such as ``camera_key``."""
    found = (cls for cls in ui.classes if issubclass(cls, bpy.types.Operator))
    return {cls.bl_idname.removeprefix("firetwin."): cls for cls in found}


def full_names(name):
    """Names of an operator in F3, with the menus that lead to it; empty without an entry."""
    return [
        f"Firetwin > {title} > {menus.entry_text(line) if isinstance(line, menus.MenuEntry) else line.text}"
        for title, lines in menus.MENUS.items()
        for line in lines
        if (
            line.operator == name
            if isinstance(line, menus.MenuEntry)
            else line.name == SUBMENUS.get(name, "no menu")
        )
    ]


def link(name):
    """Page of the manual of an operator, as right-click > Online Manual finds it."""
    patterns = manual.manual_map()[1]
    rna = f"bpy.ops.firetwin.{name}"
    return next((page for pattern, page in patterns if fnmatchcase(rna, pattern)), "")


def keys(name):
    """Shortcuts of an operator."""
    return [
        "-".join((*(each.capitalize() for each in modifiers), key))
        for operator, _, key, modifiers in keymap.SHORTCUTS
        if operator == f"firetwin.{name}"
    ]


def table():
    """Rows of the table: operator, names in F3, help link, key."""
    for name in sorted(operators()):
        why = menus.WITHOUT_ENTRY.get(name, "")
        yield name, "; ".join(full_names(name)) or f"({why})", link(name), ", ".join(keys(name))


if __name__ == "__main__":
    import firetwin

    firetwin.register()
    print("| operator | F3 | help | key |\n| --- | --- | --- | --- |")
    for row in table():
        print(f"| {' | '.join(row)} |")
    firetwin.unregister()
