"""Thumbnail maps of the run's fuel and fire in the sidebar, drawn when a run is read, then cached."""

from __future__ import annotations

import bpy
import bpy.utils.previews
import numpy as np
from numpy.typing import NDArray

Images = dict[str, NDArray[np.float32]]

_kept: dict[str, bpy.utils.previews.ImagePreviewCollection] = {}


def show(run: str, images: Images) -> None:
    """Replace all maps with the maps of a run folder."""
    clear()
    kept = _kept[run] = bpy.utils.previews.new()
    for name, pixels in images.items():
        preview = kept.new(name)
        preview.image_size = preview.icon_size = pixels.shape[1::-1]
        preview.image_pixels_float.foreach_set(pixels.ravel())
        preview.icon_pixels_float.foreach_set(pixels.ravel())


def icon(run: str, name: str) -> int:
    """Return the icon number of a map of a run folder; 0 if it is not drawn yet."""
    kept = _kept.get(run)
    return kept[name].icon_id if kept is not None and name in kept else 0


def clear() -> None:
    """Free all maps."""
    while _kept:
        bpy.utils.previews.remove(_kept.popitem()[1])


def draw(layout: bpy.types.UILayout, run: str) -> None:
    """Draw both maps side by side, with captions."""
    if not icon(run, "fuel"):
        return
    row = layout.row()
    for name, text in (("fuel", "Fuel"), ("intensity", "Intensity")):
        column = row.column(align=True)
        column.template_icon(icon_value=icon(run, name), scale=5.5)
        line = column.row()
        line.alignment = "CENTER"
        line.label(text=text)
