"""Asset builder: a shot's trees, materials, node groups and cameras as assets, with previews of trees.

Variation between trees is read from the instancer if there is one, else from the object. A single tree
therefore has these values as custom properties, and an artist can burn it by setting `arrival_time`.
"""

from __future__ import annotations

import tempfile
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

from ..blender import owned
from ..progress import Progress, silent
from ..shot.shot import Shot
from ..shot.terrain.terrain import NEVER
from . import clock, infrared, temperature
from .camera import build as camera
from .fire import build as fire
from .fire import firebrand_material
from .forest import build as forest
from .forest import library, models
from .smoke import flow_material
from .smoke import material as model_material

HEIGHTS = {
    **{"large": 35.0, "medium": 22.0, "small": 8.0, "oak": 14.0},
    **{"pine": 18.0, "spruce": 18.0, "birch": 15.0},
    **{"brush": 1.2, "log": 0.5, "rock": 0.8, "tuft": 0.4, "twigs": 0.15},
}
"""Heights (m) of one model of each class in the library."""

_HIGH = 5.0  # m; classes taller than this are trees
_PICTURE = 128  # pixels
_ALONE = {"arrival_time": NEVER, "tint": 0.5, "dead": 0.5, "scorch": 0.0, "torched": 0.0, "elevation": 1500.0}
_KINDS = {
    "GeometryNodeTree": "Geometry Nodes",
    "ShaderNodeTree": "Shader Nodes",
    "CompositorNodeTree": "Compositor",
}

Identify = Callable[[str], str]


def build(shot: Shot, identify: Identify, progress: Progress = silent) -> int:
    """Create all assets in the current file, including our node groups, and return their number.

    Parameters
    ----------
    identify
        Function that maps a catalogue's name to its UUID.
    """
    stage = owned.adopt(bpy.context.scene)
    clock.build(shot, stage)
    temperature.build(shot, stage)
    infrared.build(shot, stage)
    trees = library.tree_models(shot, stage)
    forest.node_group(shot, stage, "Firetwin Trees", trees)
    fire.node_group(shot, stage, fire.build_cards(shot, stage))
    firebrand_material.build(shot, stage)
    for look, name in ((model_material, "Model"), (flow_material, "Flow")):
        material = look.build(shot, stage)
        material.name = f"Firetwin Smoke {name}"
        for node in material.node_tree.nodes:
            if node.type == "GROUP" and node.node_tree.name.startswith("Firetwin Smoke Shader"):
                node.node_tree.name = f"Firetwin Smoke Shader {name}"
    camera.build(shot, stage)
    _mark_trees(trees, identify, progress)
    _mark_materials(identify)
    for group in filter(owned.is_ours, bpy.data.node_groups):
        _mark(group, identify(_KINDS[group.bl_idname]), _describe_group(group))
    _picture_groups(trees.objects[0])
    for obj in (obj for obj in stage.root.all_objects if obj.type == "CAMERA"):
        _mark(obj, identify("Cameras"), "A camera of the shot, with its path")
    blocks = (bpy.data.objects, bpy.data.materials, bpy.data.node_groups)
    return sum(block.asset_data is not None for kind in blocks for block in kind)


def _mark_trees(library: bpy.types.Collection, identify: Identify, progress: Progress) -> None:
    """Name and mark the finest level of every model, and render its preview."""
    count: dict[str, int] = defaultdict(int)
    every = models.every()
    with tempfile.TemporaryDirectory() as folder:
        studio = _Studio(Path(folder))
        for k, model in enumerate(every):
            progress(k, len(every), "drawing the trees")
            obj = library.objects[f"Firetwin Tree {k:02d} 0"]
            high = HEIGHTS[model.kind] > _HIGH or (model.kind, model.state) == ("brush", "living")
            what = _model_name(model)
            if model.state == "snag":
                what = f"{what} Snag" if high else f"Burned {what}"
            count[what] += 1
            obj.name = f"{what} {count[what]}"
            for name, value in _ALONE.items():
                obj[name] = value
            _mark(obj, identify("Trees" if high else "Undergrowth"), _describe_model(model, high))
            obj.scale = (HEIGHTS[model.kind],) * 3
            studio.draw(obj)
        studio.close()


def _mark_materials(identify: Identify) -> None:
    """Mark all materials; each gets the preview of the asset that shows it with the fewest others."""
    objects = [obj for obj in bpy.data.objects if obj.asset_data and obj.type == "MESH"]
    objects.sort(key=lambda obj: len(obj.data.materials))
    for material in filter(owned.is_ours, bpy.data.materials):
        _mark(material, identify("Materials"), f"{material.name}: see the inputs of its node group")
        made = next((obj for obj in objects if material.name in obj.data.materials), None)
        if made is not None:
            pixels = np.empty(_PICTURE * _PICTURE * 4, np.float32)
            made.preview.image_pixels_float.foreach_get(pixels)
            _set_preview(material, pixels)


def _picture_groups(tree: bpy.types.Object) -> None:
    """Give node groups previews: of a material that uses them, or of a tree for those that plant trees."""
    pixels = np.empty(_PICTURE * _PICTURE * 4, np.float32)
    for group in filter(owned.is_ours, bpy.data.node_groups):
        users = [material for material in bpy.data.materials if _uses(material, group)]
        shown = next((each for each in users if each.preview and each.preview.image_size[0]), None)
        if shown is None and group.bl_idname == "GeometryNodeTree" and "Tree" in group.name:
            shown = tree
        if shown is not None:
            shown.preview.image_pixels_float.foreach_get(pixels)
            _set_preview(group, pixels)


def _uses(material: bpy.types.Material, group: bpy.types.NodeTree) -> bool:
    """Return whether the node tree of a material has a node of this group."""
    nodes = material.node_tree.nodes if material.node_tree else ()
    return any(node.type == "GROUP" and node.node_tree == group for node in nodes)


def _set_preview(block: bpy.types.ID, pixels: np.ndarray) -> None:
    """Set an image as the preview of a data-block."""
    preview = block.preview_ensure()
    preview.image_size = (_PICTURE, _PICTURE)
    preview.image_pixels_float.foreach_set(pixels)


def _describe_model(model: models.TreeModel, high: bool) -> str:
    burns = "; burns when the model time passes its arrival_time" if high and model.state == "living" else ""
    return f"{_model_name(model)}, {model.state}{burns}"


def _model_name(model: models.TreeModel) -> str:
    conifers = {"large": "Large Conifer", "medium": "Conifer", "small": "Young Conifer"}
    return conifers.get(model.kind, model.kind.capitalize())


def _describe_group(group: bpy.types.NodeTree) -> str:
    """Describe a node group and its inputs."""
    names = [
        item.name
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.in_out == "INPUT" and item.parent.name
    ]
    about = group.description or ("" if names else "A part of Firetwin's materials")
    return ". ".join(filter(None, (about, f"Inputs: {', '.join(names)}" if names else "")))


def _mark(block: bpy.types.ID, catalogue: str, about: str) -> None:
    block.asset_mark()
    block.asset_data.catalog_id = catalogue
    block.asset_data.description = about
    block.asset_data.author = "Firetwin"


class _Studio:
    """A scene in which Cycles renders previews of objects with a transparent background."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / "picture.png"
        self._scene = scene = bpy.data.scenes.new("Studio")
        scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 8, False
        scene.render.resolution_x = scene.render.resolution_y = _PICTURE
        scene.render.film_transparent = True
        scene.view_settings.view_transform = "Standard"
        scene.render.filepath = str(self._path)
        self._sun = bpy.data.lights.new("Studio", "SUN")
        self._sun.energy, self._sun.angle = 20.0, 0.2
        lamp = bpy.data.objects.new("Studio Sun", self._sun)
        lamp.rotation_euler = (0.7, 0.2, 0.6)
        self._eye = bpy.data.cameras.new("Studio")
        self._eye.type, self._eye.clip_end = "ORTHO", 1000.0
        self._camera = bpy.data.objects.new("Studio Camera", self._eye)
        self._camera.rotation_euler = (np.radians(80.0), 0.0, 0.0)
        scene.camera = self._camera
        for obj in (lamp, self._camera):
            scene.collection.objects.link(obj)

    def draw(self, obj: bpy.types.Object) -> None:
        """Render an object and set the result as its preview."""
        scene = self._scene
        scene.collection.objects.link(obj)
        corners = np.array(obj.bound_box) * np.array(obj.scale)
        size, middle = np.ptp(corners, axis=0), corners.mean(axis=0)
        self._eye.ortho_scale = float(max(size.max(), 0.1) * 1.1)
        away = np.array([0.0, -np.sin(np.radians(80.0)), np.cos(np.radians(80.0))]) * 300.0
        self._camera.location = middle + away
        bpy.ops.render.render(write_still=True, scene=scene.name)
        picture = bpy.data.images.load(str(self._path))
        pixels = np.empty(_PICTURE * _PICTURE * 4, np.float32)
        picture.pixels.foreach_get(pixels)
        _set_preview(obj, pixels)
        bpy.data.images.remove(picture)
        scene.collection.objects.unlink(obj)

    def close(self) -> None:
        """Remove the scene."""
        bpy.data.batch_remove([*self._scene.collection.objects, self._eye, self._sun])
        bpy.data.scenes.remove(self._scene)
