"""What the cameras record: one view layer per kind of sensor, and the compositor behind them.

- ``rgb``: the visible picture, with the bloom of a lens.
- ``thermal``: temperatures (K) as pixel values. Materials and the world switch on the layer's property
  ``firetwin_thermal``; smoke is left out, as long-wave infrared (8 to 14 um) sees through most of it.
- ``depth``: distance along the camera's axis (m) to ground and trees; flames and smoke are left out, as they
  have no surface. One ray through the middle of each pixel. The sky is 1e10 m, as everywhere in Blender.

Data layers are never denoised: a denoiser makes 299.86 K of 300 K. The File Output nodes stay muted until a
render asks for them, so that rendering in Blender's window writes no stray files.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
from firetwin_core.run import Run

from .. import compat, nodes
from ..project import Project
from . import collections

RGB, THERMAL, DEPTH = "rgb", "thermal", "depth"
LAYERS = (RGB, THERMAL, DEPTH)

THERMAL_SAMPLES = 4  # a pixel's temperature is the mean over it, as in a detector
_LEFT_OUT = {RGB: (), THERMAL: ("Smoke", "Lamps"), DEPTH: ("Smoke", "Fire")}


def build(project: Project, run: Run, scene: bpy.types.Scene | None = None) -> list[bpy.types.ViewLayer]:
    """Make the view layers and the compositor, last of all: layers leave out collections that exist."""
    scene = scene or bpy.context.scene
    layers = [_layer(scene, name) for name in LAYERS]
    for other in [layer for layer in scene.view_layers if layer.name not in LAYERS]:
        scene.view_layers.remove(other)
    for layer in layers:
        _leave_out(layer, _LEFT_OUT[layer.name])
        layer[nodes.THERMAL] = 0.0 if layer.name == RGB else 1.0  # depth needs no light: the cheaper shader
        layer.cycles.use_denoising = layer.name == RGB and project.render.denoise
        layer.use_pass_z = layer.name == DEPTH
        layer.use = layer.name == RGB or layer.name in project.render.passes
    scene.view_layers[THERMAL].samples = THERMAL_SAMPLES
    scene.view_layers[DEPTH].samples = 1
    _compositor(scene)
    return layers


def select(scene: bpy.types.Scene, layers: Sequence[str]) -> None:
    """Render these view layers and no others."""
    for layer in scene.view_layers:
        layer.use = layer.name in layers


def write_exr(scene: bpy.types.Scene, folder: str, stems: dict[str, str]) -> None:
    """Let the coming render write ``<folder>/<stem><frame>.exr`` for each layer named in `stems`."""
    tree = compat.compositor_tree(scene)
    for layer in LAYERS:
        node = tree.nodes[f"Firetwin {layer} EXR"]
        node.mute = layer not in stems
        if layer in stems:
            compat.exr_output_path(node, folder, stems[layer])


def _layer(scene: bpy.types.Scene, name: str) -> bpy.types.ViewLayer:
    return scene.view_layers.get(name) or scene.view_layers.new(name)


def _leave_out(layer: bpy.types.ViewLayer, parts: tuple[str, ...]) -> None:
    names = {f"{collections.ROOT} {part}" for part in parts}
    pending = list(layer.layer_collection.children)
    while pending:
        child = pending.pop()
        child.exclude = child.name in names
        if not child.exclude:
            pending += child.children


def _compositor(scene: bpy.types.Scene) -> None:
    tree = compat.empty_compositor(scene)
    images = {}
    for layer in LAYERS:
        node = tree.nodes.new("CompositorNodeRLayers")
        node.scene, node.layer = scene, layer
        images[layer] = node.outputs["Depth" if layer == DEPTH else "Image"]
    images[RGB] = compat.bloom(tree, images[RGB], Threshold=2.0, Maximum=20.0, Strength=0.25)
    kelvin = tree.nodes.new("CompositorNodeSeparateColor")  # all channels hold the same number
    tree.links.new(images[THERMAL], kelvin.inputs[0])
    images[THERMAL] = kelvin.outputs[0]
    compat.composite(tree, images[RGB])
    for layer in LAYERS:
        bits = 16 if layer == RGB else 32
        node = compat.exr_output(tree, f"Firetwin {layer} EXR", images[layer], layer != RGB, bits)
        node.mute = True
