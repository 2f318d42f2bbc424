"""Draws a frame's pictures with one render of its surfaces, and with smoke that is marched along camera rays.

Cycles sees no smoke but its shadow. The visible picture, infrared radiance and depth come from one render:
AOVs tell it of heat and flames, and a pixel's first ray goes through its middle, where depth is taken. Other
passes are rendered by themselves, without smoke.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy
import numpy as np
from firetwin_core import sensor, volume
from numpy.typing import NDArray

from ..blender import compat, nodes, owned
from ..blender.owned import Stage
from ..scene import infrared
from ..scene.smoke import baker, illumination, shadow
from ..scene.smoke.flow import Flow
from ..shot import passes
from ..shot.shot import Shot
from . import composite, engine, layers, rays
from .picture import Picture

TOGETHER = ("rgb", "thermal", "depth")
"""Passes of one render; what it draws is the view layer of the first that is wanted."""

_AOVS = {nodes.SURFACE: "COLOR", nodes.FLAMES: "COLOR", nodes.WARMTH: "VALUE"}
_STEP = 0.5  # voxels, of the march
_PICTURE = "integrated picture"

Array = NDArray[np.float32]
Channels = dict[str, Array]
"""(h, w, c) each by the name of the pass, of one eye's picture."""


class Drawing:
    """A scene that is drawn so; it stays so until its Blender ends."""

    def __init__(self, shot: Shot, stage: Stage) -> None:
        self.shot, self.stage, self.scene = shot, stage, stage.scene
        self.image = _show(self.scene)
        _prepare(self.scene)
        self.shadow = _shadow(shot, stage) if shot.settings.smoke.enabled else None
        for thing in stage.things("Smoke"):
            thing.hide_render = True
        layers.exclude(self.scene, shadow.NAME.lower(), but="rgb")

    def of(self, smoke: Sequence[volume.Bricks], part: Path) -> Callable[[list[Picture]], None]:
        """What draws a frame's pictures with its smoke into a folder, up to what their `finish` does."""
        return lambda pictures: self._draw({each.name: each for each in pictures}, smoke, part)

    def _draw(self, pictures: dict[str, Picture], smoke: Sequence[volume.Bricks], part: Path) -> None:
        if self.shadow and "rgb" in pictures:
            self.shadow.cast(self.stage, smoke)
        together = {name: pictures[name] for name in TOGETHER if name in pictures}
        if together:
            self._together(together, smoke, part)
        for name in pictures:
            if name not in together:
                self._alone(pictures[name], smoke, part)

    def _together(self, pictures: dict[str, Picture], smoke: Sequence[volume.Bricks], part: Path) -> None:
        eyes = [
            _Eye(self, channels, smoke, *eye) for channels, eye in self._rendered(next(iter(pictures)), part)
        ]
        if "rgb" in pictures:
            light = np.concatenate([eye.picture() for eye in eyes])
            self._develop(light, pictures["rgb"], part)
        if "thermal" in pictures:
            heat = np.concatenate([eye.radiance(pictures["thermal"].frame) for eye in eyes])
            _write(part, pictures["thermal"], heat)
        if "depth" in pictures:
            _write(part, pictures["depth"], np.concatenate([eye.channels["Depth"][..., 0] for eye in eyes]))

    def _alone(self, picture: Picture, smoke: Sequence[volume.Bricks], part: Path) -> None:
        known = passes.known()[picture.name]
        eyes = [
            (channels, _Eye(self, channels, smoke, *eye))
            for channels, eye in self._rendered(picture.name, part)
        ]
        found = [channels["Combined" if known.output == "Image" else known.output] for channels, _ in eyes]
        if known.masks:
            found = [
                pixels * eye.transmittance()[..., None] for pixels, (_, eye) in zip(found, eyes, strict=True)
            ]
        _write(part, picture, np.concatenate(found))

    def _rendered(self, name: str, part: Path) -> Iterator[tuple[Channels, tuple[int]]]:
        """What a pass's view layer shows, of each eye, with -1 or 1 for left and right, or 0."""
        scene, each = self.scene, passes.known()[name]
        layers.select(scene, [name])
        file = part / f"surfaces_{name}.exr"
        chance = scene.cycles.min_transparent_bounces
        scene.cycles.min_transparent_bounces = (
            engine.TRANSPARENT
        )  # what ends by chance, AOVs do not make up for
        centres = engine.pixel_centres(scene, each.pixel_centres and name not in TOGETHER)
        with compat.raw_file(scene, file), centres, layers.plain(scene, [name]):
            bpy.ops.render.render(write_still=True, scene=scene.name)
        scene.cycles.min_transparent_bounces = chance
        two = scene.render.use_multiview
        for end, eye in (("_L", -1), ("_R", 1)) if two else (("", 0),):
            path = file.with_stem(file.stem + end)
            yield _channels(path), (eye,)
            path.unlink()

    def _develop(self, light: Array, picture: Picture, part: Path) -> None:
        """Give the compositor this light in place of what Cycles drew, and let it write the pass's files."""
        file = part / "light.exr"
        sensor.write_image(file, light)
        self.image.filepath = str(file)
        self.image.reload()
        scene = self.scene
        layers.write_exr(scene, str(part), [picture])
        scene.render.filepath = str(part / Path(picture.file("png")).name)
        bpy.ops.render.render(write_still=True, scene=scene.name)
        file.unlink()


class _Eye:
    """What one eye sees of surfaces and of smoke."""

    def __init__(
        self, drawing: Drawing, channels: Channels, smoke: Sequence[volume.Bricks], eye: int
    ) -> None:
        self.drawing, self.channels, self.smoke = drawing, channels, smoke
        height, width = next(iter(channels.values())).shape[:2]
        self.rays = rays.through(drawing.scene.camera, drawing.scene, height, width, eye)

    def picture(self) -> Array:
        """Radiance (h, w, 3) of surfaces behind smoke."""
        channels = self.channels
        colour = channels["Combined"]
        red, way, _ = np.moveaxis(channels[nodes.FLAMES], -1, 0)
        far = np.where(red > 1.0e-4, way / np.maximum(red, 1.0e-9), 0.0)
        surface = channels[nodes.SURFACE]
        seen = composite.Surfaces(
            colour=colour,
            noisy=channels.get("Noisy Image", colour),
            fire=np.maximum(channels[f"Combined_{nodes.FIRE}"], 0.0),
            distance=self._distance(),
            nearness=surface[..., 0],
            aside=self.rays.aside,
            solid=surface[..., 1],
            fire_distance=self.rays.of_distance(far),
        )
        at = composite.taps(seen)
        marched = np.zeros((*at.shape, 4), np.float32)
        marched[..., 3] = 1.0
        if self.smoke:
            light = illumination.visible(self.drawing.stage)
            marched = volume.march(self.smoke, *self._rays(), at.reshape(-1, 3), light, _STEP)
            marched = marched.reshape(*at.shape, 4)
        return composite.picture(seen, at, marched)

    def radiance(self, frame: int) -> Array:
        """Infrared radiance (h, w) of surfaces, air and smoke."""
        shot, channels = self.drawing.shot, self.channels
        bare = composite.radiance(
            channels[nodes.SURFACE],
            channels[nodes.FLAMES],
            channels[nodes.WARMTH][..., 0],
            infrared.sky(shot),
        )
        if not self.smoke:
            return bare
        air = illumination.warm(shot, self.drawing.stage, frame)
        found = volume.march_infrared(self.smoke, *self._rays(), self._distance().ravel(), **air)
        light, through = np.moveaxis(found.reshape(*bare.shape, 2), -1, 0)
        return bare * through + light

    def transmittance(self) -> Array:
        """Part (h, w) of green light from what the middle rays meet that comes through smoke."""
        if not self.smoke:
            return np.ones_like(self._distance())
        depth = volume.optical_depth(self.smoke, *self._rays(), self._distance().ravel(), step=_STEP)
        return np.exp(-depth * illumination.thickness(self.drawing.stage)).reshape(self._distance().shape)

    def _distance(self) -> Array:
        return self.rays.of_depth(self.channels["Depth"][..., 0])

    def _rays(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        origins = self.rays.origins
        return origins if origins.ndim == 1 else origins.reshape(-1, 3), self.rays.directions.reshape(-1, 3)


def wanted(shot: Shot, scene: bpy.types.Scene) -> bool:
    """Whether a scene's frames are drawn so: settings say so, and it has all that it takes."""
    return baker.integrated(shot) and scene.render.engine == "CYCLES"


def _prepare(scene: bpy.types.Scene) -> None:
    """Have view layers record what a picture is made of."""
    for name in TOGETHER:
        layer = layers.of_pass(scene, name)
        layer.use_pass_z = True
        layer.pass_alpha_threshold = 1.0  # flames are clear, whatever they add
        if name != "depth":
            layer.samples = 0  # the same rays for all, so that a pass does not hang on what is made with it
            known = {each.name for each in layer.aovs}
            for aov, kind in _AOVS.items():
                if aov not in known:
                    made = layer.aovs.add()
                    made.name, made.type = aov, kind
    masks = layers.of_pass(scene, "masks")
    masks.use_pass_z = True
    groups = layers.of_pass(scene, "rgb").lightgroups
    if nodes.FIRE not in {each.name for each in groups}:
        groups.add(name=nodes.FIRE)


def _shadow(shot: Shot, stage: Stage) -> shadow.Shadow | None:
    """The shadow of the shot's smoke, made anew; None where nothing burns."""
    for old in [each for each in stage.root.children if owned.ours(each, shadow.NAME)]:
        for thing in list(old.objects):
            bpy.data.objects.remove(thing)
        bpy.data.collections.remove(old)
    owned.purge()
    parts = Flow(shot).parts
    return shadow.build(shot, stage, [part.box for part in parts]) if parts else None


def _show(scene: bpy.types.Scene) -> bpy.types.Image:
    """Have the compositor take an image where it took the visible picture that Cycles drew."""
    tree = compat.compositor(scene)
    image = owned.mark(bpy.data.images.new(f"Firetwin {_PICTURE}", 4, 4, float_buffer=True, is_data=True))
    image.source = "FILE"
    if scene.render.use_multiview:
        image.use_multiview = True
        compat.over_under(image)
    node = next((each for each in tree.nodes if owned.ours(each, _PICTURE)), None)
    if node is None:
        node = owned.mark(tree.nodes.new("CompositorNodeImage"), _PICTURE)
        shown = layers.of_pass(scene, "rgb").name
        for link in list(tree.links):
            source = link.from_node
            if (
                source.bl_idname == layers.SOURCE
                and source.layer == shown
                and link.from_socket.name == "Image"
            ):
                tree.links.new(node.outputs[0], link.to_socket)
        for source in [each for each in tree.nodes if each.bl_idname == layers.SOURCE and owned.ours(each)]:
            tree.nodes.remove(source)
    node.image = image
    return image


def _channels(path: Path) -> Channels:
    """Channels of a multilayer EXR of one view layer, those of a pass together and without alpha."""
    found: dict[str, list[tuple[str, Array]]] = {}
    for name, values in sensor.read_channels(path).items():
        parts = name.split(".")
        found.setdefault(parts[1], []).append((parts[-1], values))
    return {name: np.stack([v for _, v in _ordered(each)[:3]], axis=-1) for name, each in found.items()}


def _ordered(channels: list[tuple[str, Array]]) -> list[tuple[str, Array]]:
    return sorted(channels, key=lambda pair: "RGBAXYZV".index(pair[0]))


def _write(part: Path, picture: Picture, pixels: Array) -> None:
    sensor.write_image(part / Path(picture.file("exr")).name, pixels)
