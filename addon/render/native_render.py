"""Blender's own render (F12, Ctrl-F12) of a built scene: file outputs with Firetwin's names."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import bpy

from ..blender import compat, owned
from ..blender.owned import Stage
from ..errors import Error
from ..shot import passes
from . import layers
from .picture import Picture


def unprocessed_passes() -> tuple[str, ...]:
    """List the passes that Blender's own render can write: others need special rays or post-processing."""
    rendered = layers.rendered_passes()
    return tuple(each.name for each in rendered if not each.pixel_centres and not each.finished)


def to_files(stage: Stage, out: Path, camera: str, names: tuple[str, ...]) -> None:
    """Set Blender's own renders to write these passes of a camera into an output folder.

    Parameters
    ----------
    names
        Passes; those not in `unprocessed_passes` are ignored.

    Raises
    ------
    Error
        The scene has no compositor.
    """
    chosen = [name for name in unprocessed_passes() if name in names]
    if compat.compositor(stage.scene) is None:
        raise Error("the scene has no compositor, which writes the passes; build the scene again")
    layers.repair(stage.scene)
    layers.select(stage.scene, chosen)
    pictures = {name: Picture(camera, 1, name) for name in chosen}
    for node in _nodes(stage.scene):
        what = str(node.get(owned.MARK, ""))
        if what.startswith("exr "):
            picture = pictures.get(what.removeprefix("exr "))
            node.mute = picture is None
            if picture is not None:
                compat.exr_output_path(node, str(out / camera / picture.name), picture.stem())
    still = next((name for name in chosen if layers.has_still(passes.known()[name])), None)
    if still is not None:
        stage.scene.render.filepath = str(out / camera / still / f"{pictures[still].stem()}######")


def to_none(stage: Stage) -> None:
    """Set Blender's own renders to write no pass files."""
    for node in _nodes(stage.scene):
        if str(node.get(owned.MARK, "")).startswith("exr "):
            node.mute = True


def has_outputs(scene: bpy.types.Scene) -> bool:
    """Return whether Blender's own renders write pass files."""
    return any(str(node.get(owned.MARK, "")).startswith("exr ") and not node.mute for node in _nodes(scene))


def _nodes(scene: bpy.types.Scene) -> Iterable[bpy.types.Node]:
    """Return the compositor's nodes; an artist may have removed the compositor."""
    tree = compat.compositor(scene)
    return tree.nodes if tree is not None else ()
