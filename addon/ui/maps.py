"""Thumbnails of the run's fuel and fire in the sidebar; drawn when a run is read, kept till the next."""

from __future__ import annotations

import bpy
import bpy.utils.previews
import numpy as np
from numpy.typing import NDArray

Images = dict[str, NDArray[np.float32]]

_kept: dict[str, bpy.utils.previews.ImagePreviewCollection] = {}


def show(run: str, images: Images) -> None:
    """Let these maps be those of a run folder, in place of all others."""
    forget()
    kept = _kept[run] = bpy.utils.previews.new()
    for name, pixels in images.items():
        preview = kept.new(name)
        preview.image_size = preview.icon_size = pixels.shape[1::-1]
        preview.image_pixels_float.foreach_set(pixels.ravel())
        preview.icon_pixels_float.foreach_set(pixels.ravel())


def icon(run: str, name: str) -> int:
    """Number of the icon that shows a map of a run folder; 0: none is drawn."""
    kept = _kept.get(run)
    return kept[name].icon_id if kept is not None and name in kept else 0


def forget() -> None:
    """Let go of all maps."""
    while _kept:
        bpy.utils.previews.remove(_kept.popitem()[1])


def draw(layout: bpy.types.UILayout, run: str) -> None:
    """Both maps side by side, with what they are."""
    if not icon(run, "fuel"):
        return
    row = layout.row()
    for name, text in (("fuel", "Fuel"), ("intensity", "Intensity")):
        column = row.column(align=True)
        column.template_icon(icon_value=icon(run, name), scale=5.5)
        line = column.row()
        line.alignment = "CENTER"
        line.label(text=text)
