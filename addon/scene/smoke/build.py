"""The smoke of the shot as volume objects that show the baked files of each frame."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...blender import compat, owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...smoke import bake, baker, flow_frames, view
from ...smoke.flow import Flow
from . import flow_material, layers, material

_MAX_STEPS = 8192  # Cycles lengthens steps of rays that would need more; 1024 of them are 12 km


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Smoke", which reads what `bake.bake` writes; nothing where smoke is off.

    The step along rays is set in metres. Left alone it would be the voxel size, and longer steps do not
    just blur smoke, they lose it.
    """
    collection = stage.part("Smoke")
    if not shot.settings.smoke.enabled:
        return None
    parts = _parts(shot)
    if stage.own:
        _march(stage.scene.cycles)
        _slices(stage.scene.eevee, *view.span(shot))
    layers.build(collection, len(parts))
    look = (flow_material if baker.solved(shot) else material).build(shot, stage)
    return [_hang(shot, stage, collection, part, look) for part in parts][-1]


@dataclass(frozen=True)
class _Part:
    """Files of one name: what their object is called, the first, voxel and step in m, extinction in 1/m."""

    name: str
    first: Path
    voxel: float
    step: float
    extinction: float


def _parts(shot: Shot) -> list[_Part]:
    first, drawn = bake.file(shot, 1), view.resolution(shot)
    if not baker.solved(shot):
        return [_Part("Smoke", first, drawn.voxel, drawn.step, drawn.extinction)]
    thickest = shot.settings.smoke.extinction or flow_frames.thickest(shot.scale)
    solved = shot.settings.smoke.lighting == "solved"
    depth = view.SOLVED_STEP_DEPTH if solved else view.STEP_DEPTH
    found = [
        _Part(
            "Smoke" if layer.name == "smoke" else "Far Smoke",
            layer.file(first.parent, 1),
            layer.voxel,
            depth / thickest * (1.0 if layer.fine else 2.0),
            thickest,
        )
        for layer in flow_frames.layers(shot, Flow(shot))
    ]
    return found or [_Part("Smoke", first, 100.0, 100.0, thickest)]


def _hang(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, part: _Part, look: bpy.types.Material
) -> bpy.types.Object:
    volume = bpy.data.volumes.new(f"Firetwin {part.name}")
    volume.filepath = str(part.first)
    volume.is_sequence = True
    volume.frame_start, volume.frame_duration, volume.frame_offset = 1, shot.frames.count, 0
    volume.sequence_mode = "CLIP"
    volume.render.space = "WORLD"
    volume.render.step_size = part.step
    volume.render.clipping = flow_frames.thinnest(
        shot.scale
    )  # Cycles leaves out what is thinner, in blocks that show
    volume.display.density = part.extinction  # in the solid view, like the render's
    volume.display.wireframe_type = "NONE"
    volume.materials.append(look)
    thing = owned.add(collection, part.name, volume)
    shift = compat.volume_shift(stage.scene.cycles, part.voxel)
    thing.location = (shift, shift, shift)
    return thing


def relative(blend: Path) -> None:
    """Make the paths of our volumes start at the folder of the .blend file that is about to be saved there.

    So smoke is found again when both are moved together. What lies on another drive stays where it is.
    Blender must not change the paths once more: save with ``relative_remap=False``.
    """
    for volume in bpy.data.volumes:
        if owned.ours(volume):
            volume.filepath = _beside(blend, bpy.path.abspath(volume.filepath))


def _beside(blend: Path, path: str) -> str:
    try:
        return "//" + Path(os.path.relpath(path, blend.absolute().parent)).as_posix()
    except ValueError:  # no way leads from one drive to another
        return path


def _march(cycles: bpy.types.PropertyGroup) -> None:
    cycles.volume_step_rate = 1.0
    cycles.volume_max_steps = _MAX_STEPS


def _slices(eevee: bpy.types.SceneEEVEE, near: float, far: float) -> None:
    """Have EEVEE, which cuts the view into slices of smoke, use them all where smoke is, and shade them."""
    eevee.use_volume_custom_range = True  # at its own 100 m, smoke kilometres away is silently absent
    eevee.volumetric_start, eevee.volumetric_end = near, far
    eevee.volumetric_sample_distribution = 0.5
    eevee.use_volumetric_shadows = True
    eevee.volumetric_shadow_samples = 32
