"""Text in the sidebar: rows with labels, and paragraphs."""

from __future__ import annotations

import re
import textwrap

import bpy


def labelled(layout: bpy.types.UILayout, label: str, share: float = 0.3) -> bpy.types.UILayout:
    """A row after a label that takes this share of the width, most often less than Blender's own."""
    line = layout.split(factor=share)
    line.label(text=label)
    return line.row(align=True)


class _Lines(textwrap.TextWrapper):
    """Breaks lines at blanks, but none between a number and its unit, and long paths where a folder ends."""

    wordsep_re = re.compile(r"((?<!\d)\s+|\s+(?!(?:k?m|s|min|h|K|MB|GB)\b)|(?<=[/\\])(?=[^/\\\s]))")


def paragraph(context: bpy.types.Context, layout: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    """Text on as many lines as the sidebar's width asks for."""
    scale = context.preferences.system.ui_scale
    letters = max(int((context.region.width / scale - 60) / 6.5), 16)
    for number, line in enumerate(_Lines(letters).wrap(text)):
        layout.label(text=line, icon=icon if number == 0 else ("BLANK1" if icon != "NONE" else "NONE"))
