"""Render engine settings of Cycles and EEVEE: samples, bounces, light paths and pixel filter.

The Cycles values cut render time with little change to the picture: a landscape of ash, leaves and smoke has
little indirect and transmitted light. "Cost" in the documentation gives the measurements.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

import bpy
from firetwin_core.run import Run

from ..blender import compat, owned
from ..errors import Error
from ..shot.settings import Settings

TRANSPARENT = 256
"""Transparent bounces of a ray. Blender 4.5 bounds a volume by a hull of boxes 8 voxels wide. Light rays
treat the faces of the hull as transparent surfaces. The usual dozen bounces would stop light in the gaps
between billows, and smoke would show black blocks with straight edges. A ray of the sample run meets up to 35
faces."""

_COLUMNS = 130_000  # EEVEE's volume tiles, each 128 deep: 17 million voxels at most
_CLEAR_STEPS = 4.0
"""Factor of the volume step size in infrared. The example's thermal picture (frame 4, 8 to 14 um) then
differs by 0.17 K (root mean square) from one with an eighth of the step, and its mean by 0.001 K. Another
noise seed of flames and trees changes it by 9 K. CPU time falls from 35 to 14 s."""
DEPTH_FILTER = 0.01  # pixels, the narrowest filter of Cycles: one ray through the pixel's centre


def apply(settings: Settings, scene: bpy.types.Scene) -> None:
    """Set the picture's resolution, the engine and its samples."""
    render = scene.render
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.use_border = render.film_transparent = render.use_motion_blur = False
    render.use_file_extension = render.use_overwrite = True
    compat.still_settings(render)
    render.image_settings.color_mode, render.image_settings.color_depth = "RGB", "8"
    render.image_settings.compression = 15
    render.dither_intensity = 0.0
    set_resolution(settings, scene)
    if settings.render.engine == "eevee":
        _eevee(settings, scene)
    else:
        _cycles(settings, scene)


def set_resolution(settings: Settings, scene: bpy.types.Scene) -> None:
    """Set the resolution of the picture, or of one eye for stereo panoramas, whose files have both eyes."""
    render = scene.render
    render.resolution_x, render.resolution_y = settings.render.resolution
    render.resolution_percentage = 100
    render.use_multiview = bool(settings.cameras) and all(camera.rig.around for camera in settings.cameras)
    if render.use_multiview:
        render.resolution_y //= 2
        render.views_format = "STEREO_3D"
        compat.over_under(render.image_settings)


def _cycles(settings: Settings, scene: bpy.types.Scene) -> None:
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples = settings.render.samples
    cycles.use_adaptive_sampling = False
    cycles.sampling_pattern = "TABULATED_SOBOL"  # defaults differ between Blender versions
    cycles.seed, cycles.use_animated_seed = settings.render.seed, False
    compat.set_denoising(cycles, settings.render.denoise)
    cycles.max_bounces = 4
    cycles.glossy_bounces = cycles.transmission_bounces = 0
    cycles.volume_bounces = 1  # the smoke material approximates multiple scattering
    compat.march_through_volumes(cycles)
    cycles.transparent_max_bounces = TRANSPARENT
    cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 0.0, 4.0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.film_exposure = 1.0
    scene.render.use_persistent_data = False  # guiding saved no time in three frames and takes memory
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 1.5
    cycles.fast_gi_method = "ADD"  # number of bounces: world settings, see `scene.light.build`
    filled = cycles.use_fast_gi = scene.world is not None and owned.is_ours(scene.world)
    cycles.diffuse_bounces = 0 if filled else 1  # the fill light approximates the first bounce as well
    if filled:  # our sky has no sun disc: rays from surfaces find it, and every light sample is of a lamp
        scene.world.cycles.sampling_method = "NONE"
    elif scene.world is not None:  # the automatic resolution of its map costs 2 s a frame
        scene.world.cycles.sampling_method = "MANUAL"
        scene.world.cycles.sample_map_resolution = 256


def _eevee(settings: Settings, scene: bpy.types.Scene) -> None:
    scene.render.engine = compat.eevee_id()
    eevee = scene.eevee
    eevee.taa_render_samples = settings.render.samples
    width, height = settings.render.resolution
    tile = next((size for size in (2, 4, 8) if width * height <= _COLUMNS * size**2), 16)
    eevee.volumetric_tile_size, eevee.volumetric_samples = str(tile), 128


@contextmanager
def pixel_centres(scene: bpy.types.Scene, wanted: bool = True) -> Iterator[None]:
    """Send Cycles' rays through pixel centres, as depth and masks require, if `wanted`.

    Random termination of rays in smoke and flames (Russian roulette) is disabled.
    """
    if not wanted:
        yield
        return
    before = scene.cycles.pixel_filter_type, scene.cycles.filter_width, scene.render.filter_size
    chance = scene.cycles.min_transparent_bounces
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", DEPTH_FILTER
    scene.cycles.min_transparent_bounces = TRANSPARENT
    scene.render.filter_size = 0.0
    try:
        yield
    finally:
        scene.cycles.pixel_filter_type, scene.cycles.filter_width, scene.render.filter_size = before
        scene.cycles.min_transparent_bounces = chance


@contextmanager
def long_steps(scene: bpy.types.Scene, wanted: bool = True) -> Iterator[None]:
    """Let Cycles march smoke in the longest steps that are accurate enough in infrared, if `wanted`."""
    before = scene.cycles.volume_step_rate
    scene.cycles.volume_step_rate = before * (_CLEAR_STEPS if wanted else 1.0)
    try:
        yield
    finally:
        scene.cycles.volume_step_rate = before


def check_working_space() -> None:
    """Check that Blender's working space is linear Rec.709, the space of our flame colours and skies.

    Raises
    ------
    Error
        It is another one.
    """
    space = compat.working_space()
    if "709" not in space:
        raise Error(
            f"the file's working space is {space}; set it to Linear Rec.709 in the scene's properties"
        )


def exposure(scene: bpy.types.Scene) -> float:
    """Return the exposure of the shown frame, stops; rounded, so that shares of a film have equal files."""
    return round(scene.view_settings.exposure, 3)


def describe_exposure(camera: str, stops: Collection[float]) -> str:
    """Describe the exposure of a camera's frames: ``drone is exposed by 3.9 to 4.2 stops``."""
    limits = dict.fromkeys(f"{each:.1f}" for each in (min(stops), max(stops)))
    return f"{camera} is exposed by {' to '.join(limits)} stops"


def set_metadata(run: Run, scene: bpy.types.Scene) -> None:
    """Set the metadata of all images: the run, and no values that differ between renders."""
    render = scene.render
    for name in render.bl_rna.properties.keys():  # noqa: SIM118 (a Blender collection)
        if name.startswith("use_stamp"):
            setattr(render, name, False)
    render.use_stamp_note = True
    render.stamp_note_text = f"Firetwin: {run.name}" + (" (synthetic)" if run.synthetic else "")
