"""Letters as meshes in the xy plane, and the visibility of labels and signs to camera rays only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import bpy

from ...blender import compat, owned
from ...shot.shot import Shot

_RIM, _RIM_PIXELS = 0.035, 1.3  # least width of the outline of letters: in letter heights, and in pixels
CAPITAL = 0.51
"""Height of capitals of Blender's typeface, in letter heights (measured)."""
_LEGIBLE, _MOST = 9.0, 0.1  # pixels, least height of capitals; most picture heights that letters get for it

_THIN = 0.045  # half-width of a stem


class Part(NamedTuple):
    """Points and faces of a part of a mesh, and the index of its material."""

    points: list[tuple[float, float, float]]
    faces: list[list[int]]
    material: int


def legible_size(shot: Shot, size: float) -> float:
    """Return a letter height (picture heights) at which capitals are at least 9 pixels high."""
    return max(size, min(_LEGIBLE / CAPITAL / shot.settings.render.resolution[1], _MOST))


def rim(shot: Shot, size: float) -> float:
    """Return the width of the outline of letters of this size, in letter heights."""
    return max(_RIM, _RIM_PIXELS / (size * shot.settings.render.resolution[1]))


@contextmanager
def typeface() -> Iterator[bpy.types.VectorFont | None]:
    """Provide Blender's typeface; it is removed afterwards if the file did not have it."""
    before, font = set(bpy.data.fonts), compat.typeface()
    try:
        yield font
    finally:
        if font is not None and font not in before:
            bpy.data.fonts.remove(font)


def letters(
    text: str,
    base: float,
    offset: float,
    front: float,
    font: bpy.types.VectorFont | None,
    material: int,
    size: float = 1.0,
) -> Part:
    """Make a line of text, centred on x = 0.

    Parameters
    ----------
    base
        y of the baseline.
    offset
        Expansion of the outline, in letter heights.
    front
        z.
    """
    curve = bpy.data.curves.new("Firetwin Letters", "FONT")
    curve.body, curve.align_x, curve.offset, curve.resolution_u = text, "CENTER", offset, 3
    if font is not None:
        curve.font = font
    obj = bpy.data.objects.new("Firetwin Letters", curve)
    mesh = obj.to_mesh()
    points = [(v.co.x * size, v.co.y * size + base, front) for v in mesh.vertices]
    faces = [list(polygon.vertices) for polygon in mesh.polygons]
    bpy.data.objects.remove(obj)
    bpy.data.curves.remove(curve)
    return Part(points, faces, material)


def rectangle(left: float, right: float, low: float, high: float, front: float, material: int) -> Part:
    """Make a rectangle in the plane z = `front`."""
    points = [(left, low, front), (right, low, front), (right, high, front), (left, high, front)]
    return Part(points, [[0, 1, 2, 3]], material)


def stem(top: float, material: int) -> Part:
    """Make a thin vertical bar from the origin."""
    return rectangle(-_THIN, _THIN, 0.0, top, 0.01, material)


def mesh(name: str, parts: Sequence[Part], looks: Sequence[bpy.types.Material]) -> bpy.types.Mesh:
    """Join parts to a mesh with these materials."""
    data = owned.mark(bpy.data.meshes.new(name))
    start, vertices, faces, index = 0, [], [], []
    for points, polygons, material in parts:
        vertices += points
        faces += [[start + k for k in polygon] for polygon in polygons]
        index += [material] * len(polygons)
        start += len(points)
    data.from_pydata(vertices, [], faces)  # faces of letters have different numbers of corners
    data.polygons.foreach_set("material_index", index)
    for look in looks:
        data.materials.append(look)
    return data


def camera_rays_only(obj: bpy.types.Object) -> None:
    """Make an object visible to camera rays only."""
    obj.visible_shadow = obj.visible_diffuse = obj.visible_glossy = False
    obj.visible_volume_scatter = obj.visible_transmission = False
