"""Integrated renderer: surfaces rendered by Cycles, composited with ray-marched smoke and flames.

Cycles renders only the shadow of smoke. The visible picture, infrared radiance and depth come from one
render, in which AOVs record temperature and flames, and the first ray of a pixel goes through its centre to
sample depth. Other passes, of one ray per pixel, come from a second render.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from firetwin_core import sensor, volume
from firetwin_core.flames import FlameVolume
from numpy.typing import NDArray

from ..blender import compat, nodes, owned
from ..blender.owned import Stage
from ..geometry.grids import dilate
from ..scene import cell_distances, flame_field
from ..scene.fire import build as fire
from ..scene.fire import flame_volume
from ..scene.smoke import illumination, shadow
from ..shot import exr_tags, passes
from ..shot.fire import flame_map
from ..shot.shot import Shot
from ..smoke import sources
from . import (
    engine,
    flame_distance,
    frame_cost,
    layers,
    motion_blur,
    opaque_smoke,
    rays,
    surfaces,
    text_layer,
)
from .eye import Eye
from .picture import Picture

_AOVS = {cell_distances.AOV: "VALUE", nodes.SURFACE: "COLOR", nodes.FLAMES: "COLOR", nodes.WARMTH: "VALUE"}
_PICTURE = "integrated picture"
_BLOOM = {"Threshold": 2.5, "Maximum": 20.0}  # radiance times 2^exposure; text, of 2, has no bloom
_OUTLINE = 640  # columns of a picture whose detail of flames is enough to find the pixels that show them
_CLOSE, _HALF = 0.1, 0.5  # share of the distance to the camera's target; share of the picture

Array = NDArray[np.float32]
Flames = tuple[FlameVolume | None, FlameVolume | None]
FlamesOf = Callable[[int], Flames]
CellsOf = Callable[[int], flame_distance.FlameCells | None]


class IntegratedRenderer:
    """Integrated renderer of a scene; it changes the scene's setup until its Blender process ends."""

    def __init__(self, shot: Shot, stage: Stage, cost: frame_cost.FrameCost) -> None:
        self.shot, self.stage, self.scene, self.cost = shot, stage, stage.scene, cost
        self.in_smoke: list[int] = []
        """Frames in which smoke close to the camera hides more than half of the picture."""
        self.image = _image_node(self.scene)
        _prepare(self.scene)
        flame_field.set_reach(stage, max(flame_map.reach(shot, view) for view in shot.paths))
        self.shadow = _shadow(shot, stage) if shot.settings.smoke.enabled else None
        self.hide_volumes()
        layers.exclude(self.scene, shadow.NAME.lower(), but="rgb")
        self.has_text = text_layer.build(stage)

    def hide_volumes(self) -> None:
        """Hide the volumes of smoke and flames from Cycles."""
        marched = [*self.stage.objects_of("Smoke"), *self.stage.objects_of("Fire")]
        for volume_object in (each for each in marched if each.type == "VOLUME"):
            volume_object.hide_render = True

    def frame_renderer(self, smoke: Sequence[volume.Bricks], part: Path) -> Callable[[list[Picture]], None]:
        """Return a function that renders a frame's pictures with its smoke into a folder, before `finish`."""
        return lambda pictures: self._render({picture.name: picture for picture in pictures}, smoke, part)

    def _render(self, pictures: dict[str, Picture], smoke: Sequence[volume.Bricks], part: Path) -> None:
        marched = _marched(pictures)
        for each in marched:
            _add_quantities(self.scene, each)
            pictures.setdefault("rgb", replace(pictures[each.name], name="rgb"))
        if self.shadow and "rgb" in pictures:
            with self.cost.part(frame_cost.SHADOW):
                self.shadow.cast(self.stage, smoke)
        shared = [each for each in _shared() if each.name in pictures]
        flames = functools.cache(self._flames)  # for this frame alone: they take memory
        cells = functools.cache(lambda frame: self._measure_cells(flames(frame)[1]))
        if shared:
            self._render_shared_rays(shared, marched, pictures, smoke, flames, cells, part)
        done = {each.name for each in (*shared, *marched)}
        others = [picture for name, picture in pictures.items() if name not in done]
        if others:
            self._render_centre_rays(others, smoke, flames, cells, part)

    def _render_shared_rays(
        self,
        shared: list[passes.RenderedPass],
        marched: list[passes.MarchedPass],
        pictures: dict[str, Picture],
        smoke: Sequence[volume.Bricks],
        flames_of: FlamesOf,
        cells_of: CellsOf,
        part: Path,
    ) -> None:
        """Render passes that share rays in the layer of the first one, and marched passes by them."""
        first = shared[0].name
        frame = pictures[first].frame
        infrared = any(each.shading == "radiance" and not each.geometry_only for each in shared)
        flames, outline = flames_of(frame)
        cells = None
        if "rgb" in pictures:
            cells = cells_of(frame)
            self._set_distances(cells, smoke)
        with self.cost.part(frame_cost.SURFACES):
            rendered = surfaces.render(self.scene, [first], part, infrared=infrared)
            wanted = self.has_text and "rgb" in pictures
            text = text_layer.render(self.scene, part) if wanted else {}
        eyes = [
            Eye(
                self.shot,
                self.stage,
                channels[first],
                number,
                smoke,
                flames,
                outline,
                flame_cells=cells,
                parts=bool(marched),
            )
            for number, channels in rendered
        ]
        if "rgb" in pictures:
            with self.cost.part(frame_cost.MARCH):
                light = [self._blurred(eye, text.get(eye.number), frame) for eye in eyes]
            bloom = self._write_visible(light, pictures["rgb"], part, any(each.bloom for each in marched))
            self._check_view(eyes[0], frame)
            for each in marched:
                self._write_channels(each, eyes, bloom if each.bloom else [], pictures[each.name], part)
        for name in (each.name for each in shared if each.name != "rgb"):
            with self.cost.part(name):
                halves = [passes.modules()[name].march(eye, frame) for eye in eyes]
            self._write(part, pictures[name], np.concatenate(halves))

    def _flames(self, frame: int) -> Flames:
        """Return the flames of a frame that are drawn as a volume, and the same with detail for outlines."""
        (view,) = self.shot.paths
        with self.cost.part(frame_cost.FLAMES):
            build = functools.partial(
                flame_volume.build, self.shot, view, frame, fire.torching_crowns(self.stage)
            )
            flames = build()
            return flames, flames if view.width <= _OUTLINE else build(columns=_OUTLINE)

    def _measure_cells(self, flames: FlameVolume | None) -> flame_distance.FlameCells | None:
        """Measure the flames in each cell of the picture; None without flames, or cells."""
        if flames is None or not self._has_cells:
            return None
        (view,) = self.shot.paths
        farthest = flame_map.FADE[1] * flame_map.reach(self.shot, view)
        white = 2.0**-self.scene.view_settings.exposure
        with self.cost.part(frame_cost.DISTANCE):
            lines = rays.cell_rays(self._camera, self.scene, flame_distance.CELL)
            return flame_distance.measure(flames, lines, farthest, white)

    def _set_distances(self, cells: flame_distance.FlameCells | None, smoke: Sequence[volume.Bricks]) -> None:
        """Show surfaces the flames and the opaque smoke in each cell, if they can read them."""
        opaque = None
        if smoke and self._has_cells:
            extinction = illumination.extinction_factor(self.stage)
            with self.cost.part(frame_cost.DISTANCE):
                opaque = opaque_smoke.measure(smoke, self._camera, self.scene, extinction)
        # Rays at the edge of a cell read its neighbour: without flames there, nothing would be before them.
        cell_distances.set_distances(self.stage, None if cells is None else dilate(cells.distance, 1), opaque)

    @property
    def _camera(self) -> bpy.types.Object:
        return self.stage.evaluated(self.scene.camera)

    @property
    def _has_cells(self) -> bool:
        """True for one picture in perspective: surfaces read cells by their place in it."""
        return not self.scene.render.use_multiview and self._camera.data.type == "PERSP"

    def _blurred(self, eye: Eye, text: surfaces.Channels | None, frame: int) -> Array:
        """Compute the radiance (h, w, 3) of an eye, blurred by the camera's motion."""
        return self._blur(eye, eye.picture(text), frame)

    def _blur(self, eye: Eye, light: Array, frame: int) -> Array:
        """Blur values (h, w, n) of an eye by the camera's motion."""
        exposure = self.shot.settings.render.motion_blur
        if exposure == 0.0:
            return light
        (view,) = self.shot.paths
        away = float(np.linalg.norm(view.target[frame - 1] - view.position[frame - 1]))
        return motion_blur.blur(
            light, motion_blur.apparent_distance(eye.distance, eye.clear, away), view, frame, exposure
        )

    def _check_view(self, eye: Eye, frame: int) -> None:
        """Record a frame that is mostly hidden by smoke close to the camera."""
        (view,) = self.shot.paths
        if view.perspective:
            away = float(np.linalg.norm(view.target[frame - 1] - view.position[frame - 1]))
            if eye.hidden_by_near_smoke(_CLOSE * away) > _HALF:
                self.in_smoke.append(frame)

    def warnings(self) -> list[str]:
        """Return warnings for the user about the pictures."""
        if not self.in_smoke:
            return []
        (view,) = self.shot.paths
        listed = f"frame {self.in_smoke[0]}" if len(self.in_smoke) == 1 else f"{len(self.in_smoke)} frames"
        return [
            f'camera "{view.camera.name}" is inside smoke that hides more than half of its picture in '
            f"{listed}; move it to windward, or higher"
        ]

    def _render_centre_rays(
        self,
        pictures: list[Picture],
        smoke: Sequence[volume.Bricks],
        flames_of: FlamesOf,
        cells_of: CellsOf,
        part: Path,
    ) -> None:
        """Render passes whose rays all go through pixel centres; geometry is seen by the rays of classes."""
        drawn_by = {picture.name: _centre_layer(picture.name) for picture in pictures}
        for name in (name for name, other in drawn_by.items() if name != other):
            layer = layers.find_layer(self.scene, drawn_by[name])
            setattr(layer, layers.rendered(name).layer_property, True)
        with self.cost.part(frame_cost.CENTRES):
            eyes = surfaces.render(self.scene, set(drawn_by.values()), part, centres=True)
        for picture in pictures:
            socket, halves = layers.rendered(picture.name).socket, []
            march = getattr(passes.modules()[picture.name], "march", None)
            for number, found in eyes:
                channels = found[drawn_by[picture.name]]
                if march:
                    burning = *flames_of(picture.frame), cells_of(picture.frame)
                    eye = Eye(self.shot, self.stage, channels, number, smoke, *burning)
                    with self.cost.part(picture.name):
                        halves.append(march(eye, picture.frame))
                else:
                    halves.append(channels["Combined" if socket == "Image" else socket])
            self._write(part, picture, np.concatenate(halves))

    def _write_channels(
        self, each: passes.MarchedPass, eyes: list[Eye], bloom: list[Array], picture: Picture, part: Path
    ) -> None:
        """Write the EXR of a marched pass; the bloom of each eye is not blurred by the camera's motion."""
        names, halves = [], []
        for number, eye in enumerate(eyes):
            channels = passes.modules()[each.name].march(eye, picture.frame)
            glare = {"bloom.": bloom[number]} if bloom else {}
            names = [
                name + channel
                for name, values in (channels | glare).items()
                for channel in ("RGB" if values.shape[-1] == 3 else [""])
            ]
            values = self._blur(eye, np.concatenate(list(channels.values()), axis=-1), picture.frame)
            halves.append(np.concatenate([values, *glare.values()], axis=-1))
        pixels, space = np.concatenate(halves), self.shot.settings.render.exr_space
        reds = [index for index, name in enumerate(names) if name.endswith("R")]
        for red in reds:
            pixels[..., red : red + 3] = exr_tags.to_exr_space(pixels[..., red : red + 3], space)
        stops = engine.exposure(self.scene) if reds else None
        about = exr_tags.attributes(self.shot, picture.camera, picture.frame, each.comments, stops)
        file = part / Path(picture.file("exr")).name
        sensor.write_image(file, pixels, about, names, half=each.bits == 16, one_line=True)

    def _write_visible(self, eyes: list[Array], picture: Picture, part: Path, bloom: bool) -> list[Array]:
        """Write the files of the visible picture from the radiance (h, w, 3) of each eye.

        Returns
        -------
        The light (h, w, 3) that bloom adds in each eye, if `bloom`.
        """
        glare = []
        png, exr = (part / Path(picture.file(end)).name for end in ("png", "exr"))
        shown = []
        two, self.scene.render.use_multiview = self.scene.render.use_multiview, False
        for light in eyes:
            if bloom:
                with _bloomed(self.scene, part, picture.frame) as lit:
                    self._composite(light, picture, part)
                # The compositor takes negative blue of flames as 0.
                glare.append(sensor.read_image(lit)[..., :3] - np.maximum(light, 0.0))
                lit.unlink()
            else:
                self._composite(light, picture, part)
            if two:
                shown.append(sensor.read_image(png)[..., :3])
        self.scene.render.use_multiview = two
        if two:
            sensor.write_image(png, np.concatenate(shown), {"Note": self.scene.render.stamp_note_text})
        of = picture.camera, picture.frame, engine.exposure(self.scene)
        exr_tags.write_radiance(exr, np.concatenate(eyes), self.shot, *of)
        return glare

    def _write(self, part: Path, picture: Picture, pixels: Array) -> None:
        """Write the EXR of a data pass."""
        about = exr_tags.attributes(self.shot, picture.camera, picture.frame)
        sensor.write_image(part / Path(picture.file("exr")).name, pixels, about)

    def _composite(self, light: Array, picture: Picture, part: Path) -> None:
        """Replace Cycles' picture in the compositor by this radiance, and write the PNG."""
        file = part / "light.exr"
        with self.cost.part(frame_cost.COMPOSITOR):
            sensor.write_image(file, light)
            self.image.filepath = str(file)
            self.image.reload()
            _set_bloom(self.scene)
            layers.write_exr(self.scene, str(part), [])
            self.scene.render.filepath = str(part / Path(picture.file("png")).name)
            bpy.ops.render.render(write_still=True, scene=self.scene.name)
        file.unlink()


def applies(shot: Shot, scene: bpy.types.Scene) -> bool:
    """Return whether a scene uses the integrated renderer: by its settings, and only in Cycles."""
    return sources.is_integrated(shot) and scene.render.engine == "CYCLES"


def _prepare(scene: bpy.types.Scene) -> None:
    """Set up view layers, AOVs and light groups for the integrated renderer."""
    for each in _shared():
        layer = layers.find_layer(scene, each.name)
        layer.use_pass_z = True
        layer.pass_alpha_threshold = 1.0  # flames are transparent emitters
        if not each.geometry_only:
            layer.samples = 0  # equal samples, so that a pass does not depend on other requested passes
            _add_aovs(layer, _AOVS)
    for each in filter(passes.records_masks, layers.rendered_passes()):
        layers.find_layer(scene, each.name).use_pass_z = True
    groups = layers.find_layer(scene, "rgb").lightgroups
    if nodes.FIRE not in {group.name for group in groups}:
        groups.add(name=nodes.FIRE)


def _centre_layer(name: str) -> str:
    """Return the pass in whose layer a pass of pixel centres is rendered: `masks`, if it shows geometry."""
    each = layers.rendered(name)
    if each.socket == "Image" or not each.pixel_centres:
        return name
    return next(other.name for other in layers.rendered_passes() if passes.records_masks(other))


def _shared() -> list[passes.RenderedPass]:
    """Return the passes that share rays; those that show geometry alone, whose layers have no AOVs, last."""
    shared = [each for each in layers.rendered_passes() if each.shares_rays]
    return sorted(shared, key=lambda each: each.geometry_only)


def _marched(names: Iterable[str]) -> list[passes.MarchedPass]:
    """Return the marched passes among passes, in their order."""
    return [each for name in names if isinstance(each := passes.known()[name], passes.MarchedPass)]


def _add_quantities(scene: bpy.types.Scene, each: passes.MarchedPass) -> None:
    """Add the light groups and AOVs that a pass needs to the layer of the visible picture."""
    layer = layers.find_layer(scene, "rgb")
    there = {group.name for group in layer.lightgroups}
    for name in each.light_groups:
        if name not in there:
            layer.lightgroups.add(name=name)
    _add_aovs(layer, dict.fromkeys(each.aovs, "COLOR"))


def _add_aovs(layer: bpy.types.ViewLayer, kinds: Mapping[str, str]) -> None:
    """Add missing AOVs, of these types by name, to a view layer."""
    there = {aov.name for aov in layer.aovs}
    for name, kind in kinds.items():
        if name not in there:
            aov = layer.aovs.add()
            aov.name, aov.type = name, kind


@contextmanager
def _bloomed(scene: bpy.types.Scene, part: Path, frame: int) -> Iterator[Path]:
    """Let the compositor write the picture with bloom during a `with` block, in 32 bits."""
    tree = compat.compositor(scene)
    assert tree is not None
    end = next(link for link in tree.links if link.to_node.bl_idname == compat.END)
    node = compat.exr_output(tree, "Firetwin Bloom", end.from_socket, False, 32)
    compat.exr_output_path(node, str(part), "bloom_")
    try:
        yield part / f"bloom_{frame:06d}.exr"
    finally:
        tree.nodes.remove(node)


def _shadow(shot: Shot, stage: Stage) -> shadow.Shadow | None:
    """Rebuild the shadow caster of the shot's smoke; None without fires."""
    for old in [child for child in stage.root.children if owned.is_ours(child, shadow.NAME)]:
        for caster in list(old.objects):
            bpy.data.objects.remove(caster)
        bpy.data.collections.remove(old)
    owned.purge()
    boxes = [domain.box for domain in sources.select(shot).domains]
    return shadow.build(shot, stage, boxes) if boxes else None


def _image_node(scene: bpy.types.Scene) -> bpy.types.Image:
    """Replace the visible picture of Cycles in the compositor by an image node."""
    tree = compat.compositor(scene)
    assert tree is not None  # `layers.build` has made it
    image = owned.mark(bpy.data.images.new(f"Firetwin {_PICTURE}", 4, 4, float_buffer=True, is_data=True))
    image.source = "FILE"
    node = next((each for each in tree.nodes if owned.is_ours(each, _PICTURE)), None)
    if node is None:
        node = owned.mark(tree.nodes.new("CompositorNodeImage"), _PICTURE)
        shown = layers.find_layer(scene, "rgb").name
        for link in list(tree.links):
            source = link.from_node
            if (
                source.bl_idname == layers.SOURCE
                and source.layer == shown
                and link.from_socket.name == "Image"
            ):
                tree.links.new(node.outputs[0], link.to_socket)
        for source in [
            each for each in tree.nodes if each.bl_idname == layers.SOURCE and owned.is_ours(each)
        ]:
            tree.nodes.remove(source)
    node.image = image
    return image


def _set_bloom(scene: bpy.types.Scene) -> None:
    """Set the radiance from which our bloom begins, for the exposure of the current frame."""
    tree = compat.compositor(scene)
    assert tree is not None
    for node in tree.nodes:
        if node.bl_idname == "CompositorNodeGlare" and owned.is_ours(node):
            for name, value in _BLOOM.items():
                socket = compat.find_socket(node.inputs, name)
                socket.default_value = value * 2.0**-scene.view_settings.exposure
