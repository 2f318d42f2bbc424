"""Text layout in the sidebar: rows with labels, and paragraphs."""

from __future__ import annotations

import re
import textwrap

import bpy


def labelled_row(layout: bpy.types.UILayout, label: str, share: float = 0.3) -> bpy.types.UILayout:
    """Add a row after a label of this share of the width, usually less than Blender's default."""
    line = layout.split(factor=share)
    line.label(text=label)
    return line.row(align=True)


class _Lines(textwrap.TextWrapper):
    """Text wrapper that breaks lines at blanks, but not before a unit, and long paths after a folder."""

    wordsep_re = re.compile(r"((?<!\d)\s+|\s+(?!(?:k?m|s|min|h|K|MB|GB)\b)|(?<=[/\\])(?=[^/\\\s]))")


def draw_paragraph(
    context: bpy.types.Context, layout: bpy.types.UILayout, text: str, icon: str = "NONE"
) -> None:
    """Draw text wrapped to the sidebar's width."""
    scale = context.preferences.system.ui_scale
    letters = max(int((context.region.width / scale - 60) / 6.5), 16)
    for number, line in enumerate(_Lines(letters).wrap(text)):
        layout.label(text=line, icon=icon if number == 0 else ("BLANK1" if icon != "NONE" else "NONE"))
