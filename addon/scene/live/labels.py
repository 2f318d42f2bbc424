"""Live labels: place names and signs of stations in one mesh, which a shader turns to each eye.

Letters have a constant angle at every distance, so they are legible in a headset, whose eyes are not the
scene's camera. Vertex attributes are `place` (m), `letter` (place on the label, in letter heights), `seen`
(letter height over distance, and distances between which it is drawn, m) and `ink` (colour).
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.stations import labels, station_signs
from ..labels import build as film
from ..labels import lettering, material
from ..labels.lettering import Part
from ..stations import material as station_material
from ..stations import signs
from . import switch

_ANGLE = 0.72  # height of the picture of a 28 mm lens over the distance
_SOLID = 2000.0  # m, distance for which letters have their size in Blender's solid view
_FRONT = 10.0  # factor on the distances between layers of a label, for the depth of 3D views
_FAR = 1.0e6  # m, moves of vertices that Blender allows for


@dataclass(frozen=True)
class _Labels:
    """Labels of one kind: their parts, positions (n, 3), colours of materials, and `seen` (3,)."""

    forms: list[list[Part]]
    position: NDArray[np.float64]
    inks: list[tuple[float, float, float]]
    seen: tuple[float, float, float]


def build(shot: Shot, stage: Stage, collection: bpy.types.Collection) -> bpy.types.Object | None:
    """Build "Firetwin Live Labels"; None if the film has neither labels nor signs."""
    kinds = _names(shot) + _signs(shot)
    if not kinds:
        return None
    data = _mesh(kinds)
    data.materials.append(_material(shot))
    obj = owned.add(collection, switch.LABELS, data, switch.LABELS)
    lettering.camera_rays_only(obj)
    return obj


def _names(shot: Shot) -> list[_Labels]:
    settings, places = shot.settings.labels, labels.find(shot)
    if not places.names:
        return []
    forms = film.forms(shot, places, settings.size)
    inks = list(material.COLOURS.values())
    return [_Labels(forms, places.position, inks, (_ANGLE * settings.size, 0.0, settings.distance))]


def _signs(shot: Shot) -> list[_Labels]:
    settings, shown = shot.settings.stations, station_signs.make_signs(shot)
    if not shown or not settings.signs:
        return []
    position, size = signs.places(shot, shown), _ANGLE * settings.size
    near, far = signs.forms(shot, shown, position, settings.size)
    inks = [*material.COLOURS.values(), *station_material.ACCENTS.values()]
    return [
        _Labels(near, position, inks, (size, 0.0, settings.detail)),
        _Labels(far, position, inks, (size, settings.detail, settings.distance)),
    ]


def _mesh(kinds: list[_Labels]) -> bpy.types.Mesh:
    """Create one mesh of all labels."""
    letter: list[tuple[float, float, float]] = []
    faces: list[list[int]] = []
    place, seen, ink = [], [], []
    for kind in kinds:
        for parts, at in zip(kind.forms, kind.position, strict=True):
            for points, polygons, look in parts:
                faces += [[len(letter) + k for k in polygon] for polygon in polygons]
                letter += points
                place += [at] * len(points)
                seen += [kind.seen] * len(points)
                ink += [(*kind.inks[look], 1.0)] * len(points)
    letters, places = np.array(letter), np.array(place)
    shown = places + letters[:, (0, 2, 1)] * (1.0, -1.0, 1.0) * np.array(seen)[:, :1] * _SOLID
    data = owned.mark(bpy.data.meshes.new(f"Firetwin {switch.LABELS}"))
    data.from_pydata(shown, [], faces)  # faces of letters have different numbers of corners
    add_attribute(data, "letter", "FLOAT_VECTOR", letters)
    add_attribute(data, "place", "FLOAT_VECTOR", places)
    add_attribute(data, "seen", "FLOAT_VECTOR", np.array(seen))
    add_attribute(data, "ink", "FLOAT_COLOR", np.array(ink))
    return data


def _material(shot: Shot) -> bpy.types.Material:
    """Build "Firetwin Live Labels": ink of constant brightness, and the move of each vertex."""
    result, tree = nodes.material(f"Firetwin {switch.LABELS}", material.COLOURS["Letters"])
    place = tree.attribute("place", output="Vector")
    across, up, front = tree.separate(tree.attribute("letter", output="Vector"))
    size, near, far = tree.separate(tree.attribute("seen", output="Vector"))
    eye = tree.output(
        "ShaderNodeVectorTransform",
        {"Vector": (0.0, 0.0, 0.0)},
        vector_type="POINT",
        convert_from="CAMERA",
        convert_to="WORLD",
    )
    away = tree.vector("SUBTRACT", eye, place)
    distance = tree.vector("LENGTH", away, name="Value")
    x, y, _ = tree.separate(away)
    right = tree.vector("NORMALIZE", tree.combine(-y, x, 0.0))
    toward = tree.vector("NORMALIZE", away)
    over = tree.vector("CROSS_PRODUCT", toward, right)
    plane = tree.vector("ADD", tree.vector("SCALE", right, across), tree.vector("SCALE", over, up))
    label = tree.vector("ADD", plane, tree.vector("SCALE", toward, front * _FRONT))
    scale = distance * size * (distance > near) * (distance < far)
    wanted = tree.vector("ADD", place, tree.vector("SCALE", label, scale))
    move = tree.vector("SUBTRACT", wanted, tree.output("ShaderNodeNewGeometry", name="Position"))
    inputs = {"Vector": move, "Midlevel": 0.0, "Scale": 1.0}
    moved = tree.output("ShaderNodeVectorDisplacement", inputs, space="WORLD")
    bright = tree.input(
        "Brightness",
        material.brightness(shot),
        "Radiance of white letters by the picture's exposure",
        "Label",
    )
    ink = tree.emission(tree.attribute("ink", output="Color"), bright)
    tree.surface(ink, moved)
    result.displacement_method = "DISPLACEMENT"
    result.max_vertex_displacement = _FAR
    result.cycles.emission_sampling = "NONE"
    return result
