"""Shadow of ray-marched smoke: a surface above the ground that rays of light pass through, dimmed.

Rays to lamps, and those from surfaces that find the sky, meet it; cameras do not. Its transmittance is
computed through the smoke above it: along the sun's direction for rays to the sun, and for others the mean of
five directions, each for a fifth of the sky. Objects taller than this surface (`_OVER`) get no smoke shadow.
Smoke beyond its sides is ignored: next to a column the ground is a little too bright.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import create_mesh
from ...blender.owned import Stage
from ...run import sun
from ...shot.shot import Shot
from ...smoke.domains import Box
from . import illumination

NAME = "Smoke Shadow"
_OVER = 45.0  # m above the ground, taller than all but the tallest trees
_TREES = 12.0  # m, for a small fire
_MESH = 3  # texels along a side of the mesh
_TEXEL, _TEXELS = 40.0, 1200  # m, minimum; maximum number along a side
_SUN_EVERY, _SKY_EVERY = 2, 8  # texels between points whose transmittance is computed
_MARGIN, _TOP = (2000.0, 20_000.0), 0.64  # m around the smoke; range of shadows relative to the box's height
_SUN_CONE = np.radians(0.6)  # the sun's disc has a radius of 0.27 degrees
_RING = 0.4  # sine of the mean elevation of the lower four fifths of the sky
_STEP = 2.0  # voxels
_ENDLESS = np.float32(1.0e9)  # m

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Shadow:
    """The shadow surface in a scene.

    Attributes
    ----------
    image
        Red: transmittance of sunlight; green: of skylight.
    places
        (rows, columns, 3) m, positions of the image's texels.
    """

    image: bpy.types.Image
    material: bpy.types.Material
    places: Array

    def cast(self, stage: Stage, layers: Sequence[volume.Bricks]) -> None:
        """Update the shadow to these layers, with the sun of the scene's current frame."""
        toward = illumination.sun_direction(stage)
        part = illumination.light_ray_factor(stage)
        direct = mean_transmittance(layers, self.places[::_SUN_EVERY, ::_SUN_EVERY], [toward], part)
        around = mean_transmittance(layers, self.places[::_SKY_EVERY, ::_SKY_EVERY], _sky_directions(), part)
        pixels = np.ones((*self.places.shape[:2], 4), np.float32)
        pixels[..., 0] = _interpolate_texels(direct, _SUN_EVERY, pixels.shape)
        pixels[..., 1] = _interpolate_texels(around, _SKY_EVERY, pixels.shape)
        self.image.pixels.foreach_set(pixels.ravel())
        self.image.update()
        (group,) = (node for node in self.material.node_tree.nodes if node.type == "GROUP")
        for socket, value in zip(group.node_tree.nodes["Towards the Sun"].inputs, toward, strict=True):
            socket.default_value = value


def build(shot: Shot, stage: Stage, boxes: Sequence[Box]) -> Shadow:
    """Build "Firetwin Smoke Shadow" over all ground that smoke in these boxes can shade."""
    low, high = _shaded_extent(shot, boxes)
    length = shot.scale.length
    texel = max(length(_TEXEL), float(max(high - low)) / _TEXELS)
    x, y = (np.arange(a + 0.5 * texel, b, texel) for a, b in zip(low, high, strict=True))
    east, north = np.meshgrid(x, y)
    over = min(max(length(_OVER), _TREES), _OVER)
    up = shot.bare_ground.up(east.ravel(), north.ravel()).reshape(east.shape) + over
    places = np.stack([east, north, up], axis=-1)
    image = owned.mark(
        bpy.data.images.new(f"Firetwin {NAME}", len(x), len(y), alpha=False, float_buffer=True, is_data=True)
    )
    material = _material(image, low, texel * np.array([len(x), len(y)]))
    collection = owned.child(stage.root, NAME)
    obj = owned.add(collection, NAME, _mesh(places[::_MESH, ::_MESH], material))
    for ray in ("camera", "glossy", "volume_scatter"):
        setattr(obj, f"visible_{ray}", False)
    return Shadow(image, material, places)


def _shaded_extent(shot: Shot, boxes: Sequence[Box]) -> tuple[Array, Array]:
    """Return corners (x, y), m, of the ground that the smoke can shade."""
    heights = [sun.position(shot.run, float(shot.frames.times[k]))[1] for k in (0, -1)]
    steep = np.tan(np.radians(max(min(heights), 1.0)))
    top = _TOP * max(box.levels[-1] for box in boxes)
    margin = float(np.clip(top / steep, shot.scale.length(_MARGIN[0]), _MARGIN[1]))
    corners = np.array([[box.corner, box.high] for box in boxes])
    return corners[:, 0].min(axis=0) - margin, corners[:, 1].max(axis=0) + margin


def mean_transmittance(
    layers: Sequence[volume.Bricks], places: Array, ways: Sequence[Sequence[float]], part: float
) -> NDArray[np.float32]:
    """Return the mean transmittance over directions, to points (rows, columns, 3)."""
    flat = places.reshape(-1, 3)
    end = np.full(len(flat), _ENDLESS)
    total = np.zeros(len(flat), np.float32)
    for way in ways:
        direction = np.broadcast_to(way, flat.shape)
        total += np.exp(-part * volume.optical_depth(layers, flat, direction, end, _STEP))
    return (total / len(ways)).reshape(places.shape[:2])


def _sky_directions() -> list[tuple[float, float, float]]:
    """Return unit vectors to the centres of five equal solid angles of the sky."""
    flat = float(np.sqrt(1.0 - _RING**2))
    return [(0.0, 0.0, 1.0), *((flat * c, flat * s, _RING) for c, s in ((1, 0), (-1, 0), (0, 1), (0, -1)))]


def _interpolate_texels(
    values: NDArray[np.float32], times: int, shape: tuple[int, ...]
) -> NDArray[np.float32]:
    """Interpolate values linearly for every texel between the computed ones."""
    rows, columns = (np.arange(count) / times for count in shape[:2])
    low, right = (
        np.minimum(at.astype(int), count - 1) for at, count in zip((rows, columns), values.shape, strict=True)
    )
    high, left = (np.minimum(at + 1, count - 1) for at, count in zip((low, right), values.shape, strict=True))
    v, u = (rows - low)[:, None].astype(np.float32), (columns - right)[None, :].astype(np.float32)
    below = values[low]
    row = below + (values[high] - below) * v
    return row[:, right] + (row[:, left] - row[:, right]) * u


def _mesh(places: Array, material: bpy.types.Material) -> bpy.types.Mesh:
    rows, columns = places.shape[:2]
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    faces = np.stack([corner, corner + 1, corner + columns + 1, corner + columns], axis=-1)
    data = create_mesh(f"Firetwin {NAME}", places.reshape(rows * columns, 3), faces)
    data.materials.append(material)
    return data


def _material(image: bpy.types.Image, low: Array, size: Array) -> bpy.types.Material:
    """Create a transparent material, darkened by the image over the ground from its corner `low` on."""
    material, tree = nodes.material(f"Firetwin {NAME}")
    geometry = tree.node("ShaderNodeNewGeometry")
    place = tree.vector("SUBTRACT", tree.pick(geometry, "Position"), (*low, 0.0))
    place = tree.vector("MULTIPLY", place, (*(1.0 / size), 0.0))
    texture = tree.node("ShaderNodeTexImage", {"Vector": place}, image=image, extension="EXTEND")
    direct, around, _ = tree.separate(tree.pick(texture))
    toward = tree.node("ShaderNodeCombineXYZ")
    toward.name = "Towards the Sun"
    along = tree.vector("DOT_PRODUCT", tree.pick(geometry, "Incoming"), toward, name="Value")
    to_sun = tree.math("ABSOLUTE", along) > float(np.cos(_SUN_CONE))
    through = tree.mix(to_sun, around, direct)
    colour = tree.combine(through, through, through)
    tree.surface(tree.output("ShaderNodeBsdfTransparent", {"Color": colour}))
    return material
