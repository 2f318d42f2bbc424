"""View layers, one for each pass, and the compositor that writes their files.

Data layers are never denoised: a denoiser changes 300 K to 299.86 K. The File Output nodes stay muted until a
render unmutes them, so that rendering in Blender's window writes no stray files. View layers and nodes of the
user are unchanged. Existing ones of Firetwin are reused, which preserves an artist's nodes between them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager

import bpy

from ..blender import compat, nodes, owned
from ..blender.owned import Stage
from ..shot import passes
from ..shot.passes import Pass, RenderedPass
from ..shot.settings import Settings
from . import groups
from .picture import Picture

SOURCE, _SEPARATE = "CompositorNodeRLayers", "CompositorNodeSeparateColor"


def build(settings: Settings, stage: Stage) -> None:
    """Create view layers and compositor of a Firetwin scene, and set the layers from the settings.

    Call it last: layers can only exclude existing collections.
    """
    groups.build(settings, stage)
    if not stage.is_own:
        return
    repair(stage.scene)
    for rendered_pass in rendered_passes():
        layer = _layer(stage.scene, rendered_pass)
        layer[nodes.THERMAL] = 0.0 if rendered_pass.shading == "light" else 1.0
        layer[nodes.MASKS] = 1.0 if rendered_pass.shading == "masks" else 0.0
        layer.cycles.use_denoising = rendered_pass.shading == "light" and settings.render.denoise
        if rendered_pass.layer_property:
            setattr(layer, rendered_pass.layer_property, True)
        layer.use = has_still(rendered_pass) or rendered_pass.name in settings.render.passes
        layer.samples = rendered_pass.samples or 0
        _exclude_hidden(layer, rendered_pass, None)
    _compositor(stage.scene)


def complete(settings: Settings, stage: Stage, parts: Collection[str]) -> None:
    """Update view layers after some parts were rebuilt: exclude the collections that a pass does not show.

    Missing layers are created; the rest is unchanged.
    """
    groups.build(settings, stage)
    if not stage.is_own:
        return
    repair(stage.scene)
    there = {layer.get(owned.MARK) for layer in stage.scene.view_layers}
    if any(f"pass {each.name}" not in there for each in rendered_passes()):
        build(settings, stage)
        return
    for rendered_pass in rendered_passes():
        _exclude_hidden(_layer(stage.scene, rendered_pass), rendered_pass, parts)


def remove(scene: bpy.types.Scene) -> None:
    """Remove our view layers, except the last layer of the scene, and our compositor nodes."""
    repair(scene)
    for layer in [layer for layer in scene.view_layers if owned.is_ours(layer)]:
        if len(scene.view_layers) > 1:
            scene.view_layers.remove(layer)
        else:
            owned.unmark(layer)
    tree = compat.compositor(scene)
    if tree is not None and owned.is_ours(tree):
        for node in [node for node in tree.nodes if owned.is_ours(node)]:
            tree.nodes.remove(node)
        if tree.nodes:
            owned.unmark(tree)
        else:
            compat.no_compositor(scene)


def repair(scene: bpy.types.Scene) -> None:
    """Repair compositor nodes that Blender lost when it opened a file of another version.

    They are outputs of File Output nodes, and our mark on the node with our picture.
    """
    compat.drop_copies()
    tree = compat.compositor(scene)
    if tree is None or not owned.is_ours(tree):
        return
    for node in [node for node in tree.nodes if owned.is_ours(node) and compat.has_lost_files(node)]:
        each = rendered(node[owned.MARK].removeprefix("exr "))
        tree.nodes.remove(node)
        _file(tree, each, _image(tree, each))
    for link in list(tree.links):
        what, source = str(link.to_node.get(owned.MARK, "")), link.from_node
        if what.startswith("exr ") and source.bl_idname == "CompositorNodeGlare" and owned.is_ours(source):
            lit = compat.find_socket(source.inputs, "Image")  # files of 0.1 have bloom in the EXR too
            tree.links.new(lit.links[0].from_socket, link.to_socket)
    for link in list(tree.links):
        if link.to_node.bl_idname == compat.END and owned.is_ours(link.from_node):
            owned.mark(link.to_node)


def find_layer(scene: bpy.types.Scene, name: str) -> bpy.types.ViewLayer:
    """Return the view layer of a pass."""
    return next(layer for layer in scene.view_layers if owned.is_ours(layer, f"pass {name}"))


def exclude(scene: bpy.types.Scene, part: str, but: str = "") -> None:
    """Exclude the collections of a part from the view layers of all passes but one."""
    for layer in scene.view_layers:
        if owned.is_ours(layer) and layer.get(owned.MARK) != f"pass {but}":
            for child in _parts(layer):
                if str(child.collection[owned.MARK]).lower() == part:
                    child.exclude = True


def select(scene: bpy.types.Scene, names: Iterable[str]) -> None:
    """Enable the view layers of these passes, and disable all others."""
    chosen = {f"pass {name}" for name in names}
    for layer in scene.view_layers:
        layer.use = layer.get(owned.MARK) in chosen


@contextmanager
def black_materials(scene: bpy.types.Scene, names: Iterable[str]) -> Iterator[None]:
    """Override materials by black in layers of geometry passes, so that shading costs no time.

    The override is opaque exactly where the materials of these layers are. It is disabled in scenes with
    materials of an artist.
    """
    shapes = {f"pass {name}" for name in names if rendered(name).geometry_only}
    geometry_layers = [layer for layer in scene.view_layers if layer.get(owned.MARK) in shapes]
    if not geometry_layers or not all(
        owned.is_ours(material) for material in bpy.data.materials if material.users
    ):
        yield
        return
    black, tree = nodes.material("Firetwin Plain")
    tree.surface(tree.emission((0.0, 0.0, 0.0)))
    for layer in geometry_layers:
        layer.material_override = black
    try:
        yield
    finally:
        for layer in geometry_layers:
            layer.material_override = None
        bpy.data.materials.remove(black)
        bpy.data.node_groups.remove(tree.node_tree)


def write_exr(scene: bpy.types.Scene, folder: str, pictures: Iterable[Picture]) -> None:
    """Unmute the EXR outputs of these pictures, into a folder, for the next render; mute all others."""
    stems = {f"exr {picture.name}": picture.stem() for picture in pictures}
    tree = compat.compositor(scene)
    assert tree is not None  # `build` has made it
    for node in tree.nodes:
        what = node.get(owned.MARK)
        if isinstance(what, str) and what.startswith("exr "):
            node.mute = what not in stems
            if what in stems:
                compat.exr_output_path(node, folder, stems[what])


def has_still(each: Pass) -> bool:
    """Return whether the compositor's output is this pass's PNG."""
    return "png" in each.files and not each.finished


def rendered(name: str) -> RenderedPass:
    """Look up a pass that has a view layer."""
    each = passes.known()[name]
    assert isinstance(each, RenderedPass)
    return each


def rendered_passes() -> list[RenderedPass]:
    """List the passes that have a view layer."""
    return [known_pass for known_pass in passes.known().values() if isinstance(known_pass, RenderedPass)]


def _layer(scene: bpy.types.Scene, each: RenderedPass) -> bpy.types.ViewLayer:
    """Return the view layer of a pass: an existing one, else a new scene's default layer, else a new one."""
    what = f"pass {each.name}"
    for layer in scene.view_layers:
        if owned.is_ours(layer, what):
            return layer
    spare = next((layer for layer in scene.view_layers if owned.is_ours(layer, "spare")), None)
    layer = spare or scene.view_layers.new(each.name)
    layer.name = each.name
    return owned.mark(layer, what)


def _exclude_hidden(layer: bpy.types.ViewLayer, each: RenderedPass, parts: Collection[str] | None) -> None:
    """Exclude the collections of `parts` (None: of all parts) that a pass does not show."""
    for child in _parts(layer):
        part = str(child.collection[owned.MARK]).lower()
        if parts is None or part in parts:
            written = part in ("labels", "stations")  # only visible to people
            child.exclude = part in each.excludes or (each.shading != "light" and written)


def _parts(layer: bpy.types.ViewLayer) -> Iterator[bpy.types.LayerCollection]:
    """Yield our collections in a view layer, except children of excluded collections."""
    pending = list(layer.layer_collection.children)
    while pending:
        child = pending.pop()
        if owned.is_ours(child.collection):
            yield child
        if not child.exclude:
            pending += child.children


def _compositor(scene: bpy.types.Scene) -> None:
    """Add missing nodes to our compositor; a compositor of the user is unchanged."""
    tree = compat.compositor(scene)
    if tree is None:
        tree = compat.new_compositor(scene)
    if not owned.is_ours(tree):
        return
    there = {node[owned.MARK] for node in tree.nodes if owned.is_ours(node)}
    for each in rendered_passes():
        if f"exr {each.name}" not in there:
            before = set(tree.nodes)
            _record(scene, tree, each)
            for node in set(tree.nodes) - before:
                owned.mark(node, node.get(owned.MARK, ""))


def _record(scene: bpy.types.Scene, tree: bpy.types.NodeTree, each: RenderedPass) -> None:
    """Link a pass's view layer to its EXR output and to the composite output."""
    source = tree.nodes.new(SOURCE)
    source.scene = scene
    source.layer = find_layer(scene, each.name).name
    image = source.outputs[each.socket]
    if has_still(each):
        compat.composite(tree, compat.bloom(tree, image, Threshold=2.0, Maximum=20.0, Strength=0.25))
    if each.channels == "grey" and each.socket == "Image":
        parts = tree.nodes.new(_SEPARATE)  # all channels are equal
        tree.links.new(image, parts.inputs[0])
        image = parts.outputs[0]
    _file(tree, each, image)


def _file(tree: bpy.types.NodeTree, each: RenderedPass, image: bpy.types.NodeSocket) -> None:
    """Link a socket to the EXR output of a pass."""
    node = compat.exr_output(tree, f"Firetwin {each.name} EXR", image, each.channels == "grey", each.bits)
    node.mute = True
    owned.mark(node, f"exr {each.name}")


def _image(tree: bpy.types.NodeTree, each: RenderedPass) -> bpy.types.NodeSocket:
    """Return the output socket that `_record` created for a pass's view layer."""
    ours = [node for node in tree.nodes if owned.is_ours(node)]
    source = next(node for node in ours if node.bl_idname == SOURCE and node.layer == each.name)
    image = source.outputs[each.socket]
    for link in tree.links:
        if link.from_socket == image and owned.is_ours(link.to_node) and link.to_node.bl_idname == _SEPARATE:
            return link.to_node.outputs[0]
    return image
