"""Flames near the first camera as OpenVDB files, for Blender's own render (F12) and other programs.

The files hold the field that the integrated renderer marches (`flame_volume`), as the grids `flames` and
`infrared` (extinction in visible light and in the infrared, 1/m) and `temperature` (K). They are
``<cache>/<key>/flames_000001.vdb``; the key is a hash of all inputs, so that a repeated build writes nothing.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from firetwin_core import volume
from firetwin_core.flames import CORE_HEAT, LUMINANCE_DECADES, FlameVolume, write_flames

from ...blender import compat, nodes, owned
from ...blender.owned import Stage
from ...errors import writing
from ...passes import masks
from ...run import content
from ...shot import schema
from ...shot.cameras.path import Path as CameraPath
from ...shot.fire.flame_view import FADE
from ...shot.light import exposure
from ...shot.settings import code_fingerprint
from ...shot.shot import Shot
from ...smoke import cache
from .. import flame_field, infrared
from . import flame_volume, flames

VOXEL = 0.5
"""Edge length of a voxel, m."""
_GRIDS = "flames", "infrared", "temperature"
_THIN = 1.0e-3  # 1/m, extinction below which Cycles skips a voxel


def build(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, torches: flames.Points | None
) -> bpy.types.Object | None:
    """Write the missing files and build "Firetwin Flame Volume", which reads them; None if the setting is 0.

    Billboards within the volume are left out, and fade in where it fades out.
    """
    radius = shot.settings.fire.volume_radius
    view = next((path for path in shot.paths if path.perspective), None)
    if radius <= 0.0 or view is None:
        return None
    limit = radius / FADE[1]
    place = _write(shot, view, limit, torches)
    flame_field.set_reach(stage, limit)
    data = bpy.data.volumes.new("Firetwin Flame Volume")
    data.filepath = compat.volume_path(file(place, 1))
    data.is_sequence = True
    data.frame_start, data.frame_duration, data.frame_offset = 1, shot.frames.count, 0
    data.sequence_mode = "CLIP"
    data.render.space = "WORLD"
    data.render.step_size = VOXEL
    data.render.clipping = _THIN
    data.materials.append(build_material(shot, stage))
    obj = owned.add(collection, "Flame Volume", data)
    shift = compat.volume_shift(stage.scene.cycles, VOXEL)
    obj.location = (shift, shift, shift)
    obj.visible_shadow = obj.visible_diffuse = obj.visible_volume_scatter = False
    obj.lightgroup = nodes.FIRE
    return obj


def file(place: Path, frame: int) -> Path:
    """Return the file of a frame in a folder."""
    return place / f"flames_{frame:06d}.vdb"


def _write(shot: Shot, view: CameraPath, limit: float, torches: flames.Points | None) -> Path:
    """Write the missing files of all frames; return their folder."""
    place = shot.settings.cache.absolute() / _cache_key(shot)
    with writing(place):
        place.mkdir(parents=True, exist_ok=True)
    with cache.in_use(place):
        for frame in range(1, shot.frames.count + 1):
            if not file(place, frame).exists():
                field = flame_volume.build(shot, view, frame, torches, limit)
                write_frame(file(place, frame), field, VOXEL)
    return place


def write_frame(path: Path, field: FlameVolume | None, voxel: float) -> volume.VdbSummary:
    """Write the flames of a frame on voxels of an edge length (m); None: no flames."""
    if field is None:
        empty = np.zeros((1, 1, 1), np.float32)
        return volume.write(path, dict.fromkeys(_GRIDS, empty), voxel)
    return write_flames(path, field, voxel)


def _cache_key(shot: Shot) -> str:
    """Compute the cache key: a hash of all inputs of the files."""
    aspects = {"time", "camera", "terrain", "forest", "fire"}
    return content.fingerprint(
        {
            "flames": schema.select(shot.settings, aspects),
            "sources": code_fingerprint.hashes(aspects, shot.settings.cameras),
            "run": shot.input_hashes(),
        }
    )


def build_material(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Flame Volume": emission and absorption by extinction and temperature, without scatter.

    Colours (without blue) and brightness equal `flame_volume.visible` at the exposure of the middle frame.
    """
    look, tree = nodes.material("Firetwin Flame Volume", (1.0, 0.4, 0.05))
    stops = float(exposure.at(shot, np.array([(shot.frames.count + 1) // 2]))[0])
    core = tree.input("Brightness", flame_volume.core_luminance(stops), "Luminance of the core", "Light")
    thick = tree.input("Density", 1.0, "Factor on how opaque flames are", "Density")
    density = tree.attribute("flames") * thick
    low, high = flame_volume.KELVIN
    kelvin = tree.attribute("temperature")
    heat = kelvin.ramp(low, high)
    low_green, more, bend = flame_volume.GREEN
    over = (heat - CORE_HEAT) * float(np.log(10.0))
    exponent = tree.math("MINIMUM", *(over * decades for decades in LUMINANCE_DECADES))
    colour = tree.combine(1.0, low_green + more * heat.power(bend), 0.0)
    visible = tree.emission(colour, exponent.exp() * core * density)
    black = {"Color": (0.0, 0.0, 0.0)}
    absorbed = tree.output("ShaderNodeVolumeAbsorption", {**black, "Density": density})
    shader = tree.add_shader(absorbed, visible)
    dim = tree.attribute("infrared") * thick
    radiance = infrared.surface_radiance(tree, shot, stage, kelvin)
    absorbed = tree.output("ShaderNodeVolumeAbsorption", {**black, "Density": dim})
    warm = tree.add_shader(absorbed, tree.emission((1.0, 1.0, 1.0), radiance * dim))
    shader = nodes.switch(tree, nodes.THERMAL, shader, warm)
    kind = tree.add_shader(absorbed, tree.emission((0.0, 1.0, float(masks.FIRE)), dim))
    tree.volume(nodes.switch(tree, nodes.MASKS, shader, kind))
    look.cycles.emission_sampling = "NONE"
    return look
