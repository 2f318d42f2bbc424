"""Air over a curved Earth in shader nodes: positions, heights and air along rays, for cameras in space.

Density falls with height as exp(-h / H). Along a ray from a point at height h, with m the cosine of the angle
between the ray and the vertical there, the height after s metres is h + s m + s^2 (1 - m^2) / 2R: the
parabolic approximation of a sphere of radius R. The air along the ray is integrated by Gauss-Legendre
quadrature over its first eight e-foldings, within 0.2 % (`tests/render/test_curved_air.py`).

Positions are scaled by the axes of WGS84, so that the ellipsoid becomes the unit sphere: horizon and lowest
point of a ray are then computed as on a sphere, without error (Cozzi and Ring, 3D Engine Design for Virtual
Globes, 2011, 2.4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import geo

from ..blender.nodes import Tree, Value
from ..blender.owned import Stage
from ..ellipsoid import E2, MEAN_RADIUS, A, ecef, enu_axes

_PLACE = "globe"  # property of the root collection: latitude and longitude of the scene's origin
_FOLDS, _NODES = 8.0, 6


def set_frame(stage: Stage, frame: geo.LocalFrame | None) -> None:
    """Select curved air, with this local frame, for materials built later in a scene; None: flat air.

    Node groups of the other kind of air are unregistered, so that they are built again.
    """
    before = stage.root.get(_PLACE)
    now = None if frame is None else [frame.latitude, frame.longitude]
    if (None if before is None else list(before)) == now:
        return
    for name in ("haze", "infrared"):
        if name in stage.root:
            del stage.root[name]
    if now is None:
        del stage.root[_PLACE]
    else:
        stage.root[_PLACE] = now


def earth(stage: Stage) -> Earth | None:
    """Return the Earth of a scene with curved air; None for flat air."""
    place = stage.root.get(_PLACE)
    return None if place is None else Earth.from_frame(geo.LocalFrame(place[0], place[1], 0.0))


@dataclass(frozen=True)
class Earth:
    """The Earth in the axes of a scene.

    Attributes
    ----------
    axes
        (3, 3) the scene's east, north and up as rows, in Earth-centred axes.
    origin
        (3,) the scene's origin, Earth-centred, m.
    """

    axes: np.ndarray
    origin: np.ndarray

    @classmethod
    def from_frame(cls, frame: geo.LocalFrame) -> Earth:
        """Create the Earth of a local frame."""
        north, east, up = np.radians(frame.latitude), np.radians(frame.longitude), np.array(frame.height)
        return cls(enu_axes(np.array(north), np.array(east)), ecef(np.array(north), np.array(east), up))

    def scaled(self, tree: Tree, vector: Value, position: bool = True) -> Value:
        """Scale a position, or (`position` False) a direction, to Earth-centred axes, unit ellipsoid."""
        sizes = A * np.array([1.0, 1.0, np.sqrt(1.0 - E2)])
        rows = self.axes.T / sizes[:, None]
        parts = [_dot(tree, vector, row) for row in rows]
        if position:
            parts = [part + float(at) for part, at in zip(parts, self.origin / sizes, strict=True)]
        return tree.combine(*parts)

    def upward(self, tree: Tree, scaled: Value) -> tuple[Value, Value]:
        """Return the ellipsoid's normal at a scaled position: Earth-centred, and in the scene."""
        polar = np.sqrt(1.0 - E2)
        up = tree.vector("NORMALIZE", tree.vector("MULTIPLY", scaled, (1.0, 1.0, float(1.0 / polar))))
        return up, tree.combine(*(_dot(tree, up, row) for row in self.axes))


def _dot(tree: Tree, vector: Value, row: np.ndarray) -> Value:
    return tree.vector("DOT_PRODUCT", vector, tuple(map(float, row)), name="Value")


def weighted_path_length(tree: Tree, here: Earth, height: float) -> Value:
    """Return the path length (m) from a surface to the camera, weighted by exp(-h / `height`)."""
    geometry = tree.node("ShaderNodeNewGeometry")
    scaled = here.scaled(tree, tree.pick(geometry, "Position"))
    above = (tree.vector("LENGTH", scaled, name="Value") - 1.0) * MEAN_RADIUS
    _, up = here.upward(tree, scaled)
    rise = tree.vector("DOT_PRODUCT", up, tree.pick(geometry, "Incoming"), name="Value")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    return (above * (-1.0 / height)).exp() * weighted_ray_length(tree, rise, distance, height)


def weighted_ray_length(tree: Tree, rise: Value, distance: Value, height: float) -> Value:
    """Return the length (m) of a ray of slope cosine `rise` from height 0, weighted by exp(-h / `height`)."""
    bend = (1.0 - rise * rise) * (0.5 / (MEAN_RADIUS * height))
    slope = rise * (1.0 / height)
    root = tree.math("SQRT", slope * slope + bend * (4.0 * _FOLDS))
    far = tree.math("DIVIDE", 2.0 * _FOLDS, tree.math("MAXIMUM", slope + root, 1e-12))
    length = tree.math("MINIMUM", distance, far)
    total: Value | None = None
    for at, weight in zip(*quadrature(), strict=True):
        along = length * at
        depth = along * (bend * along + slope)
        part = (-depth).exp() * weight
        total = part if total is None else total + part
    assert total is not None
    return total * length


def quadrature() -> tuple[list[float], list[float]]:
    """Return nodes (0 to 1) and weights of the quadrature."""
    at, weight = np.polynomial.legendre.leggauss(_NODES)
    return (0.5 * at + 0.5).tolist(), (0.5 * weight).tolist()


def camera_position(tree: Tree) -> Value:
    """Return the camera's position in the scene, also for rays that end in the sky."""
    return tree.output(
        "ShaderNodeVectorTransform",
        {"Vector": (0.0, 0.0, 0.0)},
        vector_type="POINT",
        convert_from="CAMERA",
        convert_to="WORLD",
    )


def daylight(tree: Tree, up: Value, sun: Value) -> Value:
    """Return daylight, 0 to 1, for this up direction; twilight while the sun is within 7 degrees."""
    return tree.vector("DOT_PRODUCT", up, sun, name="Value").smoothstep(-0.12, 0.12)
