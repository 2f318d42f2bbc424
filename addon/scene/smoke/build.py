"""The smoke of the shot as one volume object that shows the baked file of each frame."""

from __future__ import annotations

import bpy
from firetwin_core.run import Run

from .. import compat
from ..project import Project
from . import bake, collections, smoke_layers, smoke_material, smoke_view

_MAX_STEPS = 8192  # Cycles lengthens steps of rays that would need more; 1024 of them are 12 km


def build(project: Project, run: Run) -> bpy.types.Object | None:
    """Build "Firetwin Smoke", which reads what `bake.bake` writes; nothing where smoke is off.

    The step along rays is set in metres. Left alone it would be the voxel size, and longer steps do not
    just blur smoke, they lose it.
    """
    collection = collections.fresh("Smoke")
    if not project.smoke.enabled:
        return None
    volume = bpy.data.volumes.new("Firetwin Smoke")
    volume.filepath = str(bake.file(project, run, 1))
    volume.is_sequence = True
    volume.frame_start, volume.frame_duration, volume.frame_offset = 1, project.time.frames, 0
    volume.sequence_mode = "CLIP"
    volume.render.space = "WORLD"
    volume.render.step_size = bake.resolution(project, run).step
    volume.display.density = bake.resolution(project, run).extinction  # in the solid view, like the render's
    volume.display.wireframe_type = "NONE"
    volume.materials.append(smoke_material.build(project, run))
    near, far = smoke_view.span(project, run)
    for scene in bpy.data.scenes:
        scene.cycles.volume_step_rate = 1.0
        scene.cycles.volume_max_steps = _MAX_STEPS
        _slices(scene.eevee, near, far)
    smoke_layers.build(collection)
    thing = collections.add(collection, "Smoke", volume)
    shift = compat.volume_shift(bpy.context.scene.cycles, bake.resolution(project, run).voxel)
    thing.location = (shift, shift, shift)
    return thing


def _slices(eevee: bpy.types.SceneEEVEE, near: float, far: float) -> None:
    """Have EEVEE, which cuts the view into slices of smoke, use them all where smoke is, and shade them."""
    eevee.use_volume_custom_range = True  # at its own 100 m, smoke kilometres away is silently absent
    eevee.volumetric_start, eevee.volumetric_end = near, far
    eevee.volumetric_sample_distribution = 0.5
    eevee.use_volumetric_shadows = True
    eevee.volumetric_shadow_samples = 32
