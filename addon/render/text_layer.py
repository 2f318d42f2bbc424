"""View layer of labels, signs and routes, rendered without the scene, in many samples and never denoised.

A denoiser smears small letters. The integrated renderer takes labels out of the visible picture, renders them
alone and places them over it by their distance (`composite.text_layer`).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import bpy

from ..blender import nodes, owned
from ..blender.owned import Stage
from ..scene.labels.material import COVER
from . import layers, surfaces
from .surfaces import Channels

PARTS = ("labels", "stations")
"""Parts of the scene that are text."""
NAME = "text"
SAMPLES = 32
"""Samples per pixel at least: the grey levels of a letter's edge."""


def build(stage: Stage) -> bool:
    """Build the view layer, and take text out of the other layers; return False for scenes without text."""
    if not any(stage.objects_of(part.title()) for part in PARTS):
        return False
    scene = stage.scene
    for part in PARTS:
        layers.exclude(scene, part)
    layer = next((each for each in scene.view_layers if owned.is_ours(each, NAME)), None)
    if layer is None:
        layer = owned.mark(scene.view_layers.new(NAME), NAME)
        for aov, kind in ((nodes.FLAMES, "COLOR"), (COVER, "VALUE")):
            made = layer.aovs.add()
            made.name, made.type = aov, kind
    layer.use_sky, layer.cycles.use_denoising = False, False
    layer.samples = max(SAMPLES, scene.cycles.samples)
    for child in _collections(layer.layer_collection):
        child.exclude = not _has_text(child.collection)
    return True


def render(scene: bpy.types.Scene, folder: Path) -> dict[int, Channels]:
    """Render the text alone: channels by the number of the eye."""
    for layer in scene.view_layers:
        layer.use = owned.is_ours(layer, NAME)
    return {number: found[NAME] for number, found in surfaces.render_selected(scene, [NAME], folder)}


def _collections(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.LayerCollection]:
    """Yield the parts below our root, and the other collections of the scene."""
    for child in layer.children:
        if _has_text(child.collection) and not _is_text(child.collection):
            child.exclude = False
            yield from _collections(child)
        else:
            yield child


def _has_text(collection: bpy.types.Collection) -> bool:
    return _is_text(collection) or any(map(_is_text, collection.children_recursive))


def _is_text(collection: bpy.types.Collection) -> bool:
    return str(collection.get(owned.MARK, "")).lower() in PARTS
