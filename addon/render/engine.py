"""Engine settings: good pictures of smoke and forest for little time.

The values of Cycles are those under "Cost" that change the time and not the picture: light that has bounced,
or through glass, is not worth its rays in a landscape of ash, leaves and smoke.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
from firetwin_core.run import Run

from ..blender import compat, owned
from ..shot.settings.settings import Settings

TRANSPARENT = 256
"""Clear surfaces that a ray may pass. In 4.5 the faces of the hull that Cycles puts round smoke, of boxes 8
voxels wide, count for rays of light: were it the usual dozen, light across the gaps between billows would be
lost, and smoke black in blocks with straight edges. In the sample run such a ray meets up to 35 faces."""

_COLUMNS = 130_000  # of EEVEE's boxes of smoke, each 128 deep: 17 million boxes at most
_CLEAR_STEPS = 4.0
"""Times longer. The example's thermal picture (frame 4, 8 to 14 um) is then 0.17 K (root mean square) off
one by an eighth of that, and its mean 0.001 K, where another grain of flames and trees is 9 K off; 35 cpu-s
become 14."""
DEPTH_FILTER = 0.01  # pixels, the narrowest filter Cycles has: one ray through the middle of the pixel


def apply(settings: Settings, scene: bpy.types.Scene) -> None:
    """Set the size of the picture, the engine and its samples."""
    render = scene.render
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.use_border = render.film_transparent = render.use_motion_blur = False
    render.use_file_extension = render.use_overwrite = True
    compat.still_settings(render)
    render.image_settings.color_mode, render.image_settings.color_depth = "RGB", "8"
    render.image_settings.compression = 15
    render.dither_intensity = 0.0
    size(settings, scene)
    if settings.render.engine == "eevee":
        _eevee(settings, scene)
    else:
        _cycles(settings, scene)


def size(settings: Settings, scene: bpy.types.Scene) -> None:
    """Set the size of the picture: of one for each eye where all cameras see all round; files hold both."""
    render = scene.render
    render.resolution_x, render.resolution_y = settings.render.resolution
    render.resolution_percentage = 100
    render.use_multiview = bool(settings.cameras) and all(each.rig.around for each in settings.cameras)
    if render.use_multiview:
        render.resolution_y //= 2
        render.views_format = "STEREO_3D"
        compat.over_under(render.image_settings)


def _cycles(settings: Settings, scene: bpy.types.Scene) -> None:
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples = settings.render.samples
    cycles.use_adaptive_sampling = False
    cycles.sampling_pattern = "TABULATED_SOBOL"  # Blender versions start with other ones
    cycles.seed, cycles.use_animated_seed = settings.render.seed, False
    compat.set_denoising(cycles, settings.render.denoise)
    cycles.max_bounces = 4
    cycles.glossy_bounces = cycles.transmission_bounces = 0
    cycles.volume_bounces = 1  # the material of smoke stands in for more
    compat.march_through_volumes(cycles)
    cycles.transparent_max_bounces = TRANSPARENT
    cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 0.0, 4.0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.film_exposure = 1.0
    scene.render.use_persistent_data = False  # saved nothing measurable over three frames, and keeps memory
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 1.5
    cycles.fast_gi_method = "ADD"  # as much as our world says: `light.build`
    filled = cycles.use_fast_gi = scene.world is not None and owned.ours(scene.world)
    cycles.diffuse_bounces = 0 if filled else 1  # our fill stands in for the first bounce too
    if scene.world is not None:  # the sky has no sun disc: its own, finer map takes 2 s of every frame
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
    """Within, if wanted, Cycles sends its rays through the middles of pixels, as data of surfaces need it.

    None is given up by chance on its way through smoke and between flames.
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
    """Within, if wanted, Cycles goes through smoke in steps as long as infrared light allows."""
    before = scene.cycles.volume_step_rate
    scene.cycles.volume_step_rate = before * (_CLEAR_STEPS if wanted else 1.0)
    try:
        yield
    finally:
        scene.cycles.volume_step_rate = before


def label(run: Run, scene: bpy.types.Scene) -> None:
    """Have every image say in its header what it shows, and nothing that differs from render to render."""
    render = scene.render
    for name in render.bl_rna.properties.keys():  # noqa: SIM118 (a Blender collection)
        if name.startswith("use_stamp"):
            setattr(render, name, False)
    render.use_stamp_note = True
    render.stamp_note_text = f"Firetwin: {run.name}" + (" (synthetic)" if run.synthetic else "")
