"""Live smoke: transparent sheets across all three axes, from pictures that are baked once per shot.

A picture per axis has a row for each sheet and a column for each moment; shaders blend between moments. Each
sheet is an object, because EEVEE sorts transparent surfaces by object.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...geometry.grids import dilate
from ...imaging import srgb
from ...progress import MessageCallback, Progress
from ...shot.shot import Shot
from .. import haze
from ..smoke import illumination
from ..smoke.shadow import mean_transmittance
from ..terrain.fields import byte_image
from . import smoke_grid, viewers
from .shade import Shade

MOMENTS = 8
_PATCH = 4  # cells of a quad along each side
_FAINT = 1.5 / 255.0  # opacity below which a sheet has no quad
_SHADOW = 192  # pixels of the shadow along a side, at one moment
_SHADE = 0.35  # part of the light that is left in full shadow: of the sky
_OVER = 20.0  # m above the ground where the shadow is measured
_AXES = "XYZ"


@dataclass(frozen=True)
class Smoke:
    """Smoke of the shot at some moments.

    Attributes
    ----------
    slabs
        By axis, and then by moment.
    shadow
        (moments, rows, columns) part of the sunlight that is left, over the rectangle `low` to `high`, m.
    """

    grid: smoke_grid.SmokeGrid
    times: NDArray[np.float64]
    slabs: list[list[smoke_grid.Slabs]]
    shadow: NDArray[np.float32]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def bake(shot: Shot, stage: Stage, progress: Progress, tell: MessageCallback) -> Smoke | None:
    """Solve and march the smoke; None if there is none, or if its method cannot be marched."""
    if not shot.settings.smoke.enabled:
        return None
    source = smoke_grid.source(shot)
    if not source.marched or illumination.material(stage) is None:
        tell(f"the live scene has no smoke: smoke.method {source.name} is not solved; choose flow")
        return None
    count = shot.frames.count
    frames = sorted({round(frame) for frame in np.linspace(1, count, min(MOMENTS, count))})
    now, scene = stage.scene.frame_current, stage.scene
    with source.in_use():
        source.prepare(frames, progress)
        grid = smoke_grid.make(source, frames, viewers.target(shot))
        if grid is None:
            return None
        slabs: list[list[smoke_grid.Slabs]] = [[], [], []]
        shadow = []
        low, high = _shaded(grid)
        places = _ground_places(shot, low, high)
        for done, frame in enumerate(frames):
            progress(done, len(frames), "live smoke")
            layers = list(source.bricks(frame))
            scene.frame_set(frame)
            light = illumination.visible_light(stage, everywhere=True)
            for of_axis, each in zip(slabs, smoke_grid.bake(grid, layers, light), strict=True):
                of_axis.append(each)
            sun, part = illumination.sun_direction(stage), illumination.light_ray_factor(stage)
            shadow.append(mean_transmittance(layers, places, [sun], part))
        progress(len(frames), len(frames), "live smoke")
    scene.frame_set(now)
    return Smoke(grid, shot.frames.times[np.array(frames) - 1], slabs, np.stack(shadow), low, high)


def _shaded(grid: smoke_grid.SmokeGrid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners (x, y) of the ground that the smoke can shade: as far aside as it is high."""
    tall = grid.cells[2][-1] - grid.cells[2][0]
    low, high = (np.array([grid.cells[axis][end] for axis in (0, 1)]) for end in (0, -1))
    return low - tall, high + tall


def _ground_places(shot: Shot, low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return places (rows, columns, 3) a little above the ground at the pixels of the shadow."""
    x, y = (a + (np.arange(_SHADOW) + 0.5) / _SHADOW * (b - a) for a, b in zip(low, high, strict=True))
    east, north = np.meshgrid(x, y)
    up = shot.bare_ground.up(east.ravel(), north.ravel()).reshape(east.shape)
    return np.stack([east, north, up + _OVER], axis=-1)


def shade(smoke: Smoke) -> Shade:
    """Create the shader group of the smoke's shadow."""
    moments, rows, columns = smoke.shadow.shape
    pixels = np.ones((rows, moments * columns, 4), np.float32)
    pixels[..., :3] = smoke.shadow.transpose(1, 0, 2).reshape(rows, -1)[..., None]
    image = byte_image("Firetwin Live Shadow", pixels, is_data=True)
    group = owned.mark(bpy.data.node_groups.new("Firetwin Live Shade", "ShaderNodeTree"))
    group.interface.new_socket("Position", in_out="INPUT", socket_type="NodeSocketVector")
    group.interface.new_socket("Light", in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree = nodes.Tree(group)
    size = 1.0 / (smoke.high - smoke.low)
    place = tree.output("NodeGroupInput", name="Position")
    x, y, _ = tree.separate(tree.vector("MULTIPLY_ADD", place, (*size, 0.0), (*(-smoke.low * size), 0.0)))
    rim = 0.5 / columns
    u = x.ramp(rim, 1.0 - rim, rim, 1.0 - rim)
    left = _between(tree, smoke, image, u / moments, y)[0]
    inside = (x > 0.0) * (x < 1.0) * (y > 0.0) * (y < 1.0)
    tree.finish({"Light": tree.mix(inside, 1.0, left.ramp(0.0, 1.0, _SHADE, 1.0))})
    return Shade(group)


def build(stage: Stage, collection: bpy.types.Collection, smoke: Smoke) -> list[bpy.types.Object]:
    """Build "Firetwin Live Smoke X 00" and so on: the sheets."""
    objects = []
    for axis in range(3):
        light = np.stack([each.light for each in smoke.slabs[axis]])
        opacity = np.stack([each.opacity for each in smoke.slabs[axis]])
        bright = max(float(np.percentile(light, 99.9)), 1.0e-6)
        look = _material(stage, smoke, axis, light / np.float32(bright), opacity, bright)
        for slab in range(opacity.shape[1]):
            data = _sheet(smoke.grid, axis, slab, opacity[:, slab].max(axis=0))
            if data is None:
                continue
            data.materials.append(look)
            obj = owned.add(collection, f"Live Smoke {_AXES[axis]} {slab:02d}", data)
            _centre(obj)
            obj.visible_shadow = False
            objects.append(obj)
    return objects


def _sheet(
    grid: smoke_grid.SmokeGrid, axis: int, slab: int, opacity: NDArray[np.float32]
) -> bpy.types.Mesh | None:
    """Create quads where a sheet is ever visible; None if nowhere. `sheet` is their place in the picture."""
    rows, columns = opacity.shape
    blocks = (
        dilate(opacity, 1, 0.0).reshape(rows // _PATCH, _PATCH, columns // _PATCH, _PATCH).max(axis=(1, 3))
    )
    j, i = np.nonzero(blocks > _FAINT)
    if not len(j):
        return None
    corners = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
    at = (np.stack([j, i], axis=-1)[:, None] + corners) * _PATCH  # (n, 4, 2)
    kept, number = np.unique(at.reshape(-1, 2), axis=0, return_inverse=True)
    first, second = smoke_grid.plane(axis)
    place = np.empty((len(kept), 3))
    place[:, first], place[:, second] = grid.cells[first][kept[:, 0]], grid.cells[second][kept[:, 1]]
    place[:, axis] = 0.5 * (grid.slabs[axis][slab] + grid.slabs[axis][slab + 1])
    data = create_mesh(f"Firetwin Live Smoke {_AXES[axis]}", place, number.reshape(-1, 4), flat=True)
    slabs = len(grid.slabs[axis]) - 1
    sheet = np.zeros((len(kept), 3))
    sheet[:, 0], sheet[:, 1] = kept[:, 1] / columns, (slab + kept[:, 0] / rows) / slabs
    add_attribute(data, "sheet", "FLOAT_VECTOR", sheet)
    return data


def _centre(obj: bpy.types.Object) -> None:
    """Put the origin of an object in its middle, by which EEVEE sorts it."""
    place = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.attributes["position"].data.foreach_get("vector", place)
    place = place.reshape(-1, 3)
    middle = 0.5 * (place.min(axis=0) + place.max(axis=0))
    obj.data.attributes["position"].data.foreach_set("vector", (place - middle).ravel())
    obj.location = middle.tolist()


def _material(
    stage: Stage,
    smoke: Smoke,
    axis: int,
    light: NDArray[np.float32],
    opacity: NDArray[np.float32],
    bright: float,
) -> bpy.types.Material:
    """Build the material of the sheets of an axis: opacity by the angle of view, its light, and haze."""
    name = f"Firetwin Live Smoke {_AXES[axis]}"
    material, tree = nodes.material(name)
    moments, slabs, rows, columns = opacity.shape
    pixels = np.concatenate([srgb.to_display(np.clip(light, 0.0, 1.0)), opacity[..., None]], axis=-1)
    pixels = pixels.transpose(1, 2, 0, 3, 4).reshape(slabs * rows, moments * columns, 4)
    image = byte_image(name, pixels.astype(np.float32))
    u, v, _ = tree.separate(tree.attribute("sheet", output="Vector"))
    colour, alpha = _between(tree, smoke, image, u / moments, v)
    geometry = tree.node("ShaderNodeNewGeometry")
    parts = [tree.math("ABSOLUTE", part) for part in tree.separate(tree.pick(geometry, "Incoming"))]
    weights = [part * part * part * part for part in parts]
    share = weights[axis] / (weights[0] + weights[1] + weights[2])
    along = share / tree.math("MAXIMUM", parts[axis], 1.0e-3)
    thick = tree.input("Density", 1.0, "Factor on the optical depth of the smoke", "Smoke")
    clear = tree.math("MAXIMUM", 1.0 - alpha, 1.0e-3).power(along * thick)
    part, air = haze.fraction(tree, stage)
    shown = tree.mix_colour(part, tree.vector("SCALE", colour, bright), air)
    through = tree.output("ShaderNodeBsdfTransparent")
    tree.surface(tree.mix_shader(clear, tree.emission(shown), through))
    material.surface_render_method = "BLENDED"
    material.use_transparency_overlap = True
    material.use_transparent_shadow = False
    return material


def _between(
    tree: nodes.Tree, smoke: Smoke, image: bpy.types.Image, u: nodes.Value, v: nodes.Value
) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and alpha of a picture of moments at the scene's time; `u` is within the first moment."""
    moments = len(smoke.times)
    first, last = float(smoke.times[0]), float(smoke.times[-1])
    at = nodes.model_time(tree).ramp(first, max(last, first + 1.0e-3), 0.0, moments - 1.0)
    before = tree.math("FLOOR", at)
    after = tree.math("MINIMUM", before + 1.0, moments - 1.0)
    pair = []
    for moment in (before, after):
        place = tree.combine(u + moment * (1.0 / moments), v, 0.0)
        node = tree.node("ShaderNodeTexImage", {"Vector": place}, image=image, extension="EXTEND")
        pair.append((tree.pick(node, "Color"), tree.pick(node, "Alpha")))
    part = at - before
    (colour, alpha), (next_colour, next_alpha) = pair
    return tree.mix_colour(part, colour, next_colour), tree.mix(part, alpha, next_alpha)
