"""Pictures that a VR session draws for the eyes."""

from __future__ import annotations

import time

import bpy
import numpy as np
from hands import FOLDER, say

import gpu


class Eyes:
    """Opacity of black over each picture while it is watched, and the last picture.

    Blender draws the scene with an opacity of 0, and the handlers of the add-on over it.
    """

    def __init__(self) -> None:
        self.seen: list[tuple[float, float]] = []  # s, mean opacity
        self._picture = np.zeros((1, 1, 4), np.float32)
        self._handler = bpy.types.SpaceView3D.draw_handler_add(self._look, (), "XR", "POST_VIEW")

    def _look(self) -> None:
        """Read the picture that was just drawn, after the handlers of the add-on."""
        left, low, width, height = gpu.state.viewport_get()
        buffer = gpu.state.active_framebuffer_get().read_color(left, low, width, height, 4, 0, "FLOAT")
        self._picture = np.array(buffer, np.float32).reshape(height, width, 4)
        self.seen.append((time.monotonic(), float(self._picture[..., 3].mean())))

    def save(self, name: str) -> None:
        """Save the last picture."""
        height, width, _ = self._picture.shape
        image = bpy.data.images.new(name, width, height)
        linear = self._picture.clip(0.0, 1.0)
        shown = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
        shown[..., 3] = 1.0
        image.pixels.foreach_set(shown.astype(np.float32).ravel())
        image.filepath_raw, image.file_format = str(FOLDER / f"{name}.png"), "PNG"
        image.save()
        bpy.data.images.remove(image)
        say(f"picture {name}.png of an eye, {width} x {height}")

    def close(self) -> None:
        """Look no longer."""
        bpy.types.SpaceView3D.draw_handler_remove(self._handler, "XR")
