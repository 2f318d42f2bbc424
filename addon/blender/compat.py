"""Compatibility layer for Blender 4.5 LTS to 5.2 LTS; the only module that depends on the version.

It tests for features and does not compare version numbers.
"""

from __future__ import annotations

import itertools
import locale
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..errors import Error, input_error
from . import owned

Numbers = Sequence[float] | NDArray[np.int64] | NDArray[np.floating]

_SOCKET_ALIASES = {"Fac": "Factor", "Factor": "Fac"}


def eevee_id() -> str:
    """Return the identifier of the EEVEE engine: BLENDER_EEVEE_NEXT in 4.5, BLENDER_EEVEE from 5.0."""
    engines = bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items
    return "BLENDER_EEVEE_NEXT" if "BLENDER_EEVEE_NEXT" in engines else "BLENDER_EEVEE"


def require_alembic() -> None:
    """Check that this Blender reads and writes Alembic; builds of Debian do not.

    Raises
    ------
    Error
        It does not.
    """
    if not bpy.app.build_options.alembic:
        raise Error("this Blender has no Alembic; use Blender from blender.org, or a USD stage")


def new_fcurve(datablock: bpy.types.ID, data_path: str, index: int = 0) -> bpy.types.FCurve:
    """Create an F-curve on `datablock`, and an action if it has none.

    Legacy actions (`action.fcurves`) are gone in 5.0; slotted ones work from 4.4 on.
    """
    animation = datablock.animation_data or datablock.animation_data_create()
    if animation.action is None:
        animation.action = owned.mark(bpy.data.actions.new(_action_name(datablock)))
    curve = animation.action.fcurve_ensure_for_datablock(datablock, data_path, index=index)
    curve.keyframe_points.clear()
    return curve


def _action_name(datablock: bpy.types.ID) -> str:
    return f"Firetwin {datablock.name.removeprefix('Firetwin ')} Action"


def animate(datablock: bpy.types.ID, data_path: str, index: int, frames: Numbers, values: Numbers) -> None:
    """Animate a property through `values` at `frames`, both (n,), with linear interpolation."""
    curve = new_fcurve(datablock, data_path, index)
    curve.keyframe_points.add(len(frames))
    pairs = [number for pair in zip(frames, values, strict=True) for number in pair]
    curve.keyframe_points.foreach_set("co", pairs)
    linear = bpy.types.Keyframe.bl_rna.properties["interpolation"].enum_items["LINEAR"].value
    curve.keyframe_points.foreach_set("interpolation", [linear] * len(frames))
    curve.update()


def animate_smoothly(
    datablock: bpy.types.ID,
    data_path: str,
    index: int,
    frames: Numbers,
    values: Numbers,
    slopes: Numbers,
) -> None:
    """Animate a property through `values` at `frames` with `slopes` (per frame), all (n,), in Bezier curves.

    Handles are aligned and reach a third of the way to the next keyframe, so each segment is the cubic
    Hermite curve of these ends and slopes.
    """
    curve = new_fcurve(datablock, data_path, index)
    points = curve.keyframe_points
    points.add(len(frames))
    kinds = {
        name: points[0].bl_rna.properties[name].enum_items for name in ("interpolation", "handle_left_type")
    }
    points.foreach_set("interpolation", [kinds["interpolation"]["BEZIER"].value] * len(frames))
    for side in ("handle_left_type", "handle_right_type"):
        points.foreach_set(side, [kinds["handle_left_type"]["ALIGNED"].value] * len(frames))
    gaps = [after - before for before, after in itertools.pairwise(frames)] or [1.0]
    for k, point in enumerate(points):
        frame, value, slope = float(frames[k]), float(values[k]), float(slopes[k])
        before, after = gaps[max(k - 1, 0)] / 3.0, gaps[min(k, len(gaps) - 1)] / 3.0
        point.co = frame, value
        point.handle_left = frame - before, value - slope * before
        point.handle_right = frame + after, value + slope * after


def fcurves(datablock: bpy.types.ID) -> list[bpy.types.FCurve]:
    """Return all F-curves that animate `datablock`."""
    return [curve for bag in _channelbags(datablock) for curve in bag.fcurves]


def _channelbags(datablock: bpy.types.ID) -> list[bpy.types.ActionChannelbag]:
    animation = datablock.animation_data
    if animation is None or animation.action is None:
        return []
    return [
        bag
        for layer in animation.action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        if bag.slot == animation.action_slot
    ]


def remove_fcurves(datablock: bpy.types.ID, paths: Sequence[str]) -> None:
    """Remove the F-curves of these data paths."""
    for bag in _channelbags(datablock):
        for curve in [curve for curve in bag.fcurves if curve.data_path in paths]:
            bag.fcurves.remove(curve)


def node_tree(owner: bpy.types.Material | bpy.types.World | bpy.types.Light) -> bpy.types.NodeTree:
    """Return the empty shader tree of a new material, world or light.

    Materials and worlds have one from the start in 5.0, where their `use_nodes` is deprecated.
    """
    if owner.node_tree is None:
        owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def find_socket(sockets: bpy.types.bpy_prop_collection, name: str | int) -> bpy.types.NodeSocket:
    """Find the enabled socket by name, else by identifier, else by index.

    Lookup by name would return hidden sockets in 4.5 and fail on them in 5.2. Factor and Fac are equivalent.
    """
    usable = [socket for socket in sockets if socket.enabled]
    if isinstance(name, int):
        return usable[name]
    for wanted in (name, _SOCKET_ALIASES.get(name)):
        for socket in usable:
            if wanted is not None and wanted in (socket.name, socket.identifier):
                return socket
    known = ", ".join(socket.name for socket in usable)
    raise KeyError(f"no socket {name!r}; there are: {known}")


def set_sky(node: bpy.types.ShaderNodeTexSky, elevation: float, rotation: float, dust: float) -> None:
    """Set a sky texture to a physical sky with single scattering, from sea level, without sun disc.

    Nishita's model in 4.5 is called single scattering from 5.0 on.

    Parameters
    ----------
    elevation, rotation
        Height of the sun above the horizon and its clockwise bearing from +y, radians.
    dust
        Aerosol density, 1 for urban haze.
    """
    kinds = node.bl_rna.properties["sky_type"].enum_items
    node.sky_type = "NISHITA" if "NISHITA" in kinds else "SINGLE_SCATTERING"
    node.sun_disc = False
    node.sun_elevation = elevation
    node.sun_rotation = rotation
    node.altitude = 0.0
    setattr(node, "dust_density" if hasattr(node, "dust_density") else "aerosol_density", dust)


_COMPOSITOR = "Firetwin Compositor"


def compositor(scene: bpy.types.Scene) -> bpy.types.NodeTree | None:
    """Return a scene's compositor tree: from 5.0 on a node group, before that embedded in the scene."""
    if hasattr(scene, "compositing_node_group"):
        return scene.compositing_node_group
    return scene.node_tree


def new_compositor(scene: bpy.types.Scene) -> bpy.types.NodeTree:
    """Create an empty, owned compositor tree for a scene that has none."""
    if hasattr(scene, "compositing_node_group"):
        tree = bpy.data.node_groups.new(_COMPOSITOR, "CompositorNodeTree")
        scene.compositing_node_group = tree
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
    return owned.mark(tree)


def no_compositor(scene: bpy.types.Scene) -> None:
    """Remove a scene's empty compositor, and delete it if it has no other users."""
    if hasattr(scene, "compositing_node_group"):
        tree = scene.compositing_node_group
        scene.compositing_node_group = None
        if not bpy.data.user_map(subset=[tree])[tree]:  # files of 4.5 count one user too many
            bpy.data.node_groups.remove(tree)
    else:
        scene.use_nodes = False
        owned.unmark(scene.node_tree)


END = "CompositorNodeComposite" if hasattr(bpy.types, "CompositorNodeComposite") else "NodeGroupOutput"
"""Type of the compositor's output node."""


def composite(tree: bpy.types.NodeTree, image: bpy.types.NodeSocket) -> bpy.types.Node:
    """Connect `image` to the output of a new compositor, and return the output node."""
    if END == "NodeGroupOutput":
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    output = tree.nodes.new(END)
    tree.links.new(image, output.inputs[0])
    return output


def bloom(tree: bpy.types.NodeTree, image: bpy.types.NodeSocket, **settings: float) -> bpy.types.NodeSocket:
    """Add a low-quality bloom to `image`; `settings` are Glare sockets such as Threshold and Strength."""
    glare = tree.nodes.new("CompositorNodeGlare")
    if hasattr(glare, "glare_type"):
        glare.glare_type, glare.quality = "BLOOM", "LOW"
    else:
        find_socket(glare.inputs, "Type").default_value = "Bloom"
        find_socket(glare.inputs, "Quality").default_value = "Low"
    for name, value in settings.items():
        find_socket(glare.inputs, name).default_value = value
    tree.links.new(image, find_socket(glare.inputs, "Image"))
    return find_socket(glare.outputs, "Image")


def whole_pixels(translate: bpy.types.Node) -> bpy.types.Node:
    """Set a Translate node of the compositor to whole pixels, so that rounding blends no neighbours."""
    if hasattr(translate, "interpolation"):
        translate.interpolation = "NEAREST"
    else:
        find_socket(translate.inputs, "Interpolation").default_value = "Nearest"
    return translate


def exr_output(
    tree: bpy.types.NodeTree, name: str, image: bpy.types.NodeSocket, grey: bool, bits: int
) -> bpy.types.Node:
    """Add a File Output node called `name` that writes `image` as EXR; `exr_output_path` sets its path."""
    node = tree.nodes.new("CompositorNodeOutputFile")
    node.name = node.label = name
    if hasattr(node, "file_output_items"):
        node.format.media_type = "IMAGE"
        node.file_output_items.new("FLOAT" if grey else "RGBA", "Image")
    node.format.file_format = "OPEN_EXR"
    node.format.color_mode, node.format.color_depth = "BW" if grey else "RGB", str(bits)
    node.format.exr_codec = "ZIP"
    over_under(node.format)
    tree.links.new(image, node.inputs[0])
    return node


@contextmanager
def raw_file(scene: bpy.types.Scene, path: Path) -> Iterator[None]:
    """Write all passes of view layers into an uncompressed 32-bit multilayer EXR during a `with` block.

    The compositor is bypassed. Stereo scenes add ``_L`` and ``_R`` to the file's name.
    """
    render, file = scene.render, scene.render.image_settings
    media = getattr(file, "media_type", None)
    names = ["file_format", "color_depth", "exr_codec", "views_format"]
    if hasattr(file, "use_exr_interleave"):  # otherwise 5.2 writes one part per pass
        names.append("use_exr_interleave")
    before = {name: getattr(file, name) for name in names}
    compositing, place = render.use_compositing, render.filepath
    if media is not None:
        file.media_type = "MULTI_LAYER_IMAGE"
    file.file_format, file.color_depth, file.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    file.views_format = "INDIVIDUAL"
    if "use_exr_interleave" in names:
        file.use_exr_interleave = True
    render.use_compositing, render.filepath = False, str(path)
    try:
        yield
    finally:
        if media is not None:
            file.media_type = media
        for name in names:
            setattr(file, name, before[name])
        render.use_compositing, render.filepath = compositing, place


def over_under(file: bpy.types.ImageFormatSettings) -> None:
    """Write both eyes of stereo scenes into one file of twice the height, the left eye at the top."""
    file.views_format = "STEREO_3D"
    file.stereo_3d_format.display_mode = "TOPBOTTOM"
    file.stereo_3d_format.use_squeezed_frame = False


def exr_output_path(node: bpy.types.Node, folder: str, stem: str) -> None:
    """Set an `exr_output` node to write ``<folder>/<stem><frame, six digits>.exr``."""
    if hasattr(node, "file_output_items"):
        node.directory, node.file_name = folder, stem
        node.file_output_items[0].name = "######"
    else:
        node.base_path = folder
        node.file_slots[0].path = f"{stem}######"


def has_lost_files(node: bpy.types.Node) -> bool:
    """Return True if an `exr_output` node has no file items, as in 4.5 for files of 5.0 and later."""
    if node.bl_idname != "CompositorNodeOutputFile":
        return False
    return not (node.file_output_items if hasattr(node, "file_output_items") else node.file_slots)


def drop_copies() -> None:
    """Remove duplicates of owned compositors, which 4.5 creates in files of 5.0 and later."""
    if "compositing_node_group" not in bpy.types.Scene.bl_rna.properties:
        for name in ("Compositing Node Tree", _COMPOSITOR):
            tree = bpy.data.node_groups.get(name)
            if tree is not None and owned.is_ours(tree):
                bpy.data.node_groups.remove(tree)


def new_strip(
    editor: bpy.types.SequenceEditor,
    name: str,
    kind: str,
    channel: int,
    start: int,
    length: int,
    inputs: Sequence[bpy.types.Strip] = (),
) -> bpy.types.Strip:
    """Add an effect strip of `inputs` to the sequencer; 5.0 expects its length, 4.5 its end."""
    strips = editor.strips
    parameters = strips.bl_rna.functions["new_effect"].parameters
    extent = {"length": length} if "length" in parameters else {"frame_end": start + length}
    sources = {f"input{number}": strip for number, strip in enumerate(inputs, start=1)}
    return strips.new_effect(name=name, type=kind, channel=channel, frame_start=start, **extent, **sources)


def strip_span(strip: bpy.types.Strip) -> tuple[int, int]:
    """Return the first frame and the length of a strip, which have other names from 5.2 on."""
    if hasattr(strip, "left_handle"):
        return int(strip.left_handle), int(strip.duration)
    return int(strip.frame_final_start), int(strip.frame_final_duration)


def march_through_volumes(cycles: bpy.types.PropertyGroup) -> None:
    """Set Cycles to biased ray marching of volumes, as in 4.5; 5.0 also has unbiased sampling."""
    if hasattr(cycles, "volume_biased"):
        cycles.volume_biased = True


def volume_path(path: Path) -> str:
    """Return the path of a volume file for Blender.

    OpenVDB of Blender on Windows reads UTF-8 in the code page of the process, and Blender then shows no
    volume. A command of Python has the code page of the system.

    Raises
    ------
    InputError
        Blender would not find the file.
    """
    if sys.platform == "win32" and not str(path).isascii() and locale.getencoding() != "cp65001":
        remedy = 'set cache to another one, such as "C:/cache"'
        raise input_error(path.parent, f"is a folder that Blender reads no volumes from; {remedy}")
    return str(path)


def volume_shift(cycles: bpy.types.PropertyGroup, voxel: float) -> float:
    """Return the offset (m) along each axis that draws a volume at the position of its grids.

    4.5 draws grids half a voxel too far along +x, +y and +z, in both engines. 5.0 draws them at their
    position, with `volume_biased` on or off.
    """
    return 0.0 if hasattr(cycles, "volume_biased") else -0.5 * voxel


def working_space() -> str:
    """Return the name of the scene-linear working space, which can be chosen from 5.0 on."""
    return str(getattr(getattr(bpy.data, "colorspace", None), "working_space", "Linear Rec.709"))


def still_settings(render: bpy.types.RenderSettings) -> None:
    """Set a render to write one PNG file per frame; from 5.0 on the media type must not be video."""
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format = "PNG"


_COVERED = range(0x530), range(0x1E00, 0x2C00)
"""Code points of Latin, Greek and Cyrillic letters, signs and arrows, which Blender's typeface has."""


def typeface() -> bpy.types.VectorFont | None:
    """Load Blender's typeface from its file; None if it is not installed.

    The built-in one is identical, but 5.2 loses it when it opens a second file in background mode.
    """
    path = typeface_path()
    return bpy.data.fonts.load(path, check_existing=True) if path else None


def strip_typeface(text: str) -> bpy.types.VectorFont | None:
    """Return the typeface of a text strip: Blender's for Latin, Greek and Cyrillic letters, otherwise None.

    A strip with a typeface draws boxes for letters of other scripts, which the built-in typefaces cover.
    """
    return typeface() if all(any(ord(each) in part for part in _COVERED) for each in text) else None


def typeface_path() -> str:
    """Return the path of Blender's typeface; empty if it is not installed."""
    path = os.path.join(bpy.utils.system_resource("DATAFILES", path="fonts"), "Inter.woff2")
    return path if os.path.isfile(path) else ""


def set_frame_rate(render: bpy.types.RenderSettings, rate: Fraction) -> None:
    """Set the frames per second of a scene; Blender's films have exactly this rate."""
    render.fps, render.fps_base = round(rate), round(rate) / float(rate)


def film_settings(render: bpy.types.RenderSettings) -> None:
    """Set a render to write one film file with the FFmpeg of Blender."""
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "VIDEO"
    render.image_settings.file_format = "FFMPEG"


def set_denoising(cycles: Any, wanted: bool) -> None:
    """Denoise with OpenImageDenoise, if `wanted`; not available in some builds of Blender, such as Debian's.

    Balanced quality needs 2.6 s of CPU time for 640 x 360 pixels, high quality 6 s. Pictures of 3 samples
    differ by FLIP 0.03 between the two, and by 0.045 between noise seeds; with smoke by 0.04 and 0.075.
    Guiding passes are prefiltered by the fast method: it needs 0.7 s less than the accurate one, and trees
    and flames stay sharper. Without prefiltering the time is the same, and noise remains.
    """
    try:
        cycles.denoiser, cycles.denoising_prefilter = "OPENIMAGEDENOISE", "FAST"
        cycles.denoising_quality = "BALANCED"
    except TypeError:
        wanted = False
    cycles.use_denoising = wanted


def stored_properties(datablock: bpy.types.ID) -> Any:
    """Return stored values of registered properties by name, also of properties that no longer exist."""
    # 5.0 stores them separately from custom properties
    system = getattr(datablock, "bl_system_properties_get", None)
    return (system() if system else datablock) or {}
