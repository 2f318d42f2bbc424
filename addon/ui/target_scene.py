"""Target scene of a build: an unused scene, Firetwin's scene, or a new one."""

from __future__ import annotations

import bpy
import numpy as np

from ..blender import compat, owned
from . import properties

_STARTUP = {"Camera", "Cube", "Light"}
_STARTUP_WORLD = {"ShaderNodeOutputWorld", "ShaderNodeBackground"}
_STARTUP_GREY = (0.05087609,) * 3


def prepare(scene: bpy.types.Scene, part: bool) -> tuple[int, str]:
    """Prepare the scene to build into.

    Parameters
    ----------
    part
        Only a part is rebuilt: a scene that has objects of Firetwin is the target.

    Returns
    -------
    `session_uid` of the scene, message for the user
    """
    if owned.is_ours(scene) or (part and owned.has_data(scene)):
        return scene.session_uid, ""
    if not is_vacant(scene):
        made = owned.new_scene()
        properties.copy(scene, made)
        _show_scene(scene, made)
        return made.session_uid, f"in a new scene, {made.name}; {scene.name} is unchanged"
    gone = _remove_startup_objects(scene)
    owned.adopt(scene)
    return (
        scene.session_uid,
        "the startup cube, light and camera are removed (undo restores them)" if gone else "",
    )


def is_vacant(scene: bpy.types.Scene) -> bool:
    """Return whether a scene is empty, or has only Blender's unchanged startup objects."""
    tree, editor = compat.compositor(scene), scene.sequence_editor
    return (
        (not scene.collection.all_objects or _has_startup_objects(scene))
        and _is_default_world(scene.world)
        and (tree is None or not tree.nodes)
        and scene.animation_data is None
        and (editor is None or not editor.strips)
        and len(scene.view_layers) == 1
    )


def _has_startup_objects(scene: bpy.types.Scene) -> bool:
    """Return whether the scene has only the startup file's cube, light and camera."""
    cube = scene.objects.get("Cube")
    return (
        not bpy.data.filepath
        and {obj.name for obj in scene.collection.all_objects} == _STARTUP
        and cube.type == "MESH"
        and len(cube.data.vertices) == 8
        and cube.matrix_world.is_identity
    )


def _is_default_world(world: bpy.types.World | None) -> bool:
    """Return whether a world is missing, or is the grey one of the startup file."""
    if world is None:
        return True
    if world.library is not None or world.animation_data is not None or world.node_tree is None:
        return False
    nodes = world.node_tree.nodes
    light = next((node for node in nodes if node.bl_idname == "ShaderNodeBackground"), None)
    if light is None or {node.bl_idname for node in nodes} != _STARTUP_WORLD:
        return False
    colour, strength = (light.inputs[name].default_value for name in ("Color", "Strength"))
    return np.allclose((*colour[:3], strength), (*_STARTUP_GREY, 1.0), rtol=1.0e-4)


def _remove_startup_objects(scene: bpy.types.Scene) -> bool:
    """Remove the startup objects and world of a vacant scene; return whether there were such objects."""
    objects = list(scene.collection.all_objects)
    bpy.data.batch_remove(objects)
    world, scene.world = scene.world, None
    if world is not None and world.users == 0:
        bpy.data.worlds.remove(world)
    return bool(objects)


def _show_scene(before: bpy.types.Scene, after: bpy.types.Scene) -> None:
    """Show another scene in the current window."""
    window = bpy.context.window
    if window is not None and window.scene == before:
        window.scene = after


def remove(scene: bpy.types.Scene) -> None:
    """Remove Firetwin's objects from a scene; delete a scene that was created for them, if empty."""
    from ..render import layers
    from ..scene import build

    made = owned.is_ours(scene, owned.MADE)
    if owned.is_ours(scene):
        layers.remove(scene)
    build.remove(scene)
    if made and is_vacant(scene) and not scene.collection.children and len(bpy.data.scenes) > 1:
        bpy.data.scenes.remove(scene)
