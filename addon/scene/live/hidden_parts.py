"""Parts of a scene that renders draw and 3D views do not, with reasons and remedies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy

from ...blender import owned
from ..smoke import volume_files
from . import switch

LIVE = "The live scene is shown in place of the film's ground, trees, fire and smoke"


def why_not_drawn(scene: bpy.types.Scene, layer: bpy.types.ViewLayer | None = None) -> list[str]:
    """Return a sentence for each part of the scene that 3D views do not show as renders do.

    Parameters
    ----------
    layer
        View layer of the 3D view; None: the first one.
    """
    stage, layer = owned.find_stage(scene), layer or scene.view_layers[0]
    if stage is None:
        return ["Nothing is built in this scene: press Build scene"]
    if reason := _why_collection_hidden(stage.root, layer):
        return [f"Firetwin is hidden: {reason}"]
    live = switch.is_live(scene)
    told = [LIVE] if live else []
    replaced = switch.replaced_objects(stage) if live else []
    others = {switch.COLLECTION, *(switch.REPLACED if live else ())}
    for part in stage.root.children:
        if part.all_objects and str(part.get(owned.MARK, "")) not in others:
            told += _why_hidden(part, layer, replaced)
    if not live and volume_files.missing(stage, [scene.frame_current]):
        told.append(f"Smoke of frame {scene.frame_current} has no volume yet: press Smoke of frame")
    return told


def _why_hidden(
    part: bpy.types.Collection, layer: bpy.types.ViewLayer, replaced: Sequence[bpy.types.Object]
) -> Iterator[str]:
    """Iterate over reasons why 3D views do not draw a part of the scene, or some objects not replaced."""
    name = str(part.get(owned.MARK, part.name))
    if reason := _why_collection_hidden(part, layer):
        yield f"{name} is hidden: {reason}"
        return
    for obj in part.all_objects:
        if obj in replaced or obj.hide_render or not owned.is_ours(obj):
            continue
        if reason := _why_object_hidden(obj, name, layer):
            yield f"{obj.name} {reason}"


def _why_collection_hidden(collection: bpy.types.Collection, layer: bpy.types.ViewLayer) -> str:
    """Return why 3D views do not draw a collection; empty if they do."""
    row = _row(layer.layer_collection, collection)
    if row is None or row.exclude:
        return f'its collection is excluded from the view layer "{layer.name}"'
    if collection.hide_viewport:
        return "its collection is disabled in viewports"
    return "the eye of its collection in the outliner is closed" if row.hide_viewport else ""


def _why_object_hidden(obj: bpy.types.Object, part: str, layer: bpy.types.ViewLayer) -> str:
    """Return why 3D views do not draw an object that renders draw; empty if they do."""
    if obj.hide_viewport and not obj.visible_camera:
        return "lights renders only: 3D views would show its cards"
    if obj.hide_viewport and part == "Forest":
        return "is replaced by fewer plants: 3D views redraw all of them too slowly"
    if obj.hide_viewport:
        return "is hidden: it is disabled in viewports"
    return "is hidden: Alt H in the 3D view shows it" if obj.hide_get(view_layer=layer) else ""


def _row(above: bpy.types.LayerCollection, wanted: bpy.types.Collection) -> bpy.types.LayerCollection | None:
    """Find the row of a collection in a view layer."""
    if above.collection == wanted:
        return above
    return next((found for child in above.children if (found := _row(child, wanted))), None)
