"""Smoke builder: volume objects that load the baked OpenVDB files of each frame."""

from __future__ import annotations

from pathlib import Path

import bpy

from ...blender import compat, owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...smoke import bake, flow_frames, sources, view
from . import flow_material, layers, material

_MAX_STEPS = 8192  # Cycles lengthens the steps of rays that need more; 1024 steps are 12 km


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Smoke", which reads the files of `bake.bake`; None if smoke is off.

    The step size along rays is set in metres. The default is the voxel size. Longer steps would not only blur
    smoke but miss parts of it.
    """
    collection = stage.part("Smoke")
    if not shot.settings.smoke.enabled:
        return None
    source, place = sources.select(shot), bake.folder(shot)
    drawn = source.layers()
    if stage.is_own:
        _set_cycles_steps(stage.scene.cycles)
        _set_eevee_slices(stage.scene.eevee, *view.span(shot))
    layers.build(collection, len(drawn))
    look = (flow_material if source.marched else material).build(shot, stage)
    return [_add_volume(shot, stage, collection, each, place, look) for each in drawn][-1]


def _add_volume(
    shot: Shot,
    stage: Stage,
    collection: bpy.types.Collection,
    layer: sources.VolumeLayer,
    place: Path,
    look: bpy.types.Material,
) -> bpy.types.Object:
    """Add the volume object of a layer, whose files are in the folder `place`."""
    name = "Smoke" if layer.name == "smoke" else f"{layer.name.title()} Smoke"
    volume = bpy.data.volumes.new(f"Firetwin {name}")
    file = layer.file(place, 1)
    volume.filepath = str(file) if sources.is_integrated(shot) else compat.volume_path(file)
    volume.is_sequence = True
    volume.frame_start, volume.frame_duration, volume.frame_offset = 1, shot.frames.count, 0
    volume.sequence_mode = "CLIP"
    volume.render.space = "WORLD"
    volume.render.step_size = layer.step
    # Cycles culls thinner smoke, in visible blocks.
    volume.render.clipping = flow_frames.min_extinction(shot.scale)
    volume.display.density = layer.extinction  # in the solid view, like the render's
    volume.display.wireframe_type = "NONE"
    volume.materials.append(look)
    obj = owned.add(collection, name, volume)
    shift = compat.volume_shift(stage.scene.cycles, layer.voxel)
    obj.location = (shift, shift, shift)
    return obj


def _set_cycles_steps(cycles: bpy.types.PropertyGroup) -> None:
    cycles.volume_step_rate = 1.0
    cycles.volume_max_steps = _MAX_STEPS


def _set_eevee_slices(eevee: bpy.types.SceneEEVEE, near: float, far: float) -> None:
    """Set EEVEE's volume slices to the depth range of smoke, with shadows."""
    eevee.use_volume_custom_range = True  # its default of 100 m omits distant smoke
    eevee.volumetric_start, eevee.volumetric_end = near, far
    eevee.volumetric_sample_distribution = 0.5
    eevee.use_volumetric_shadows = True
    eevee.volumetric_shadow_samples = 32
