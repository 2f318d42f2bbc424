"""Pictures of a file's live scene by Blender alone; needs no Firetwin.

usage: python bare_frames.py FILE.blend PICTURES.npz [--addon]
       blender --background --python bare_frames.py -- FILE.blend PICTURES.npz

Writes frames 1 and 3 as "film" (with all animation), and of nothing and of each part of the live scene, where
only the time of the scene is animated: arrays (2, height, width, 4). With --addon the add-on is registered.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np

PARTS = ("Ground", "Trees", "Flames", "Smoke")
SIZE, SAMPLES, FRAMES = (48, 27), 4, (1, 3)


def main(blend: str, out: str, *options: str) -> None:
    """Open the file, render, and write the pictures."""
    if "--addon" in options:
        import firetwin

        firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=blend, use_scripts=False)
    scene = bpy.context.scene
    _prepare(scene, Path(out).with_suffix(".exr"))
    _show(scene, PARTS)
    pictures = {"film": _shoot(scene)}
    _keep_time_alone(scene)
    for names in ((), *((name,) for name in PARTS)):
        _show(scene, names)
        pictures[names[0] if names else "nothing"] = _shoot(scene)
    np.savez(out, **pictures)
    if "--addon" in options:
        firetwin.unregister()
    elif "firetwin" in sys.modules:
        raise SystemExit("Firetwin was imported")


def _prepare(scene: bpy.types.Scene, path: Path) -> None:
    """Set small renders without noise that moves."""
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.seed = SAMPLES, False, 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_animated_seed = False
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage, scene.render.use_compositing = 100, False
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format, scene.render.filepath = "OPEN_EXR", str(path)
    for layer in scene.view_layers:
        layer.use = layer == scene.view_layers[0]


def _show(scene: bpy.types.Scene, names: tuple[str, ...]) -> None:
    """Render these parts of the live scene, nothing of the film's, and the light."""
    (root,) = (child for child in scene.collection.children if child.name == "Firetwin")
    for child in root.children:
        child.hide_render = child.name not in ("Firetwin Live", "Firetwin Light")
    for obj in list(bpy.data.collections["Firetwin Live"].all_objects):
        obj.hide_render = not obj.name.startswith(tuple(f"Firetwin Live {name}" for name in names))


def _keep_time_alone(scene: bpy.types.Scene) -> None:
    """Delete all animation in the pose of frame 2, except the time of the scene."""
    scene.frame_set(2)
    for kind in ("objects", "cameras", "lights", "worlds", "node_groups", "materials", "meshes"):
        for block in getattr(bpy.data, kind):
            for animated in (block, getattr(block, "node_tree", None)):
                if animated is not None:
                    animated.animation_data_clear()


def _shoot(scene: bpy.types.Scene) -> np.ndarray:
    """Render the frames: pixels (2, height, width, 4), scene-linear."""
    pictures = []
    for frame in FRAMES:
        scene.frame_set(frame)
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        pictures.append(pixels.reshape(SIZE[1], SIZE[0], 4))
        bpy.data.images.remove(image)
    return np.stack(pictures)


if __name__ == "__main__":
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    main(*given)
