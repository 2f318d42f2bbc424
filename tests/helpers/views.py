"""Contexts of a 3D view for panels that are drawn without a window."""

from types import SimpleNamespace

import bpy


def space(**values: object) -> SimpleNamespace:
    """Make a 3D view."""
    shading = SimpleNamespace(type=values.pop("shading", "RENDERED"), use_scene_world=True)
    return SimpleNamespace(**{"shading": shading, "local_view": None, "clip_end": 500_000.0, **values})


def context(scene: bpy.types.Scene, width: int = 300) -> SimpleNamespace:
    """Make the context of a panel in the sidebar of a 3D view, with this width."""
    return SimpleNamespace(
        scene=scene,
        window_manager=bpy.context.window_manager,
        view_layer=scene.view_layers[0],
        space_data=space(),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(width=width),
    )
