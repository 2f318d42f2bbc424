"""Air about a curved Earth in shader nodes: places, heights and air along rays, for cameras in space.

Density falls with height as exp(-h / H). Along a ray from a point at height h, whose direction has the cosine
m with the vertical there, the height after s metres is h + s m + s^2 (1 - m^2) / 2R: the parabola about a
sphere of radius R. The air along it is integrated by Gauss-Legendre quadrature over its first eight
e-foldings, within 0.2 % (`tests/render/test_curved_air.py`).

Places are scaled by the axes of WGS84, so that the ellipsoid is the unit sphere: the horizon and a ray's
lowest point are those of a sphere, without an error (Cozzi and Ring, 3D Engine Design for Virtual Globes,
2011, 2.4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import geo

from ..blender.nodes import Tree, Value
from ..blender.owned import Stage
from ..ellipsoid import E2, A, ecef, enu_axes

RADIUS = 6_371_000.0  # m
_PLACE = "globe"  # property of the root collection: latitude and longitude of the scene's origin
_FOLDS, _NODES = 8.0, 6


def switch(stage: Stage, frame: geo.LocalFrame | None) -> None:
    """Make air curved about the Earth of a scene with this frame, for later materials; None: flat.

    Groups of nodes for the other kind of air are forgotten, so that they are made again.
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
    """The Earth of a scene with curved air; None for flat air."""
    place = stage.root.get(_PLACE)
    return None if place is None else Earth.of(geo.LocalFrame(place[0], place[1], 0.0))


@dataclass(frozen=True)
class Earth:
    """The Earth in a scene's axes.

    Attributes
    ----------
    axes
        (3, 3) scene's east, north and up as rows, in Earth-centred axes.
    origin
        (3,) scene's origin, Earth-centred, m.
    """

    axes: np.ndarray
    origin: np.ndarray

    @classmethod
    def of(cls, frame: geo.LocalFrame) -> Earth:
        """The Earth of a frame."""
        north, east, up = np.radians(frame.latitude), np.radians(frame.longitude), np.array(frame.height)
        return cls(enu_axes(np.array(north), np.array(east)), ecef(np.array(north), np.array(east), up))

    def scaled(self, tree: Tree, vector: Value, whole: bool = True) -> Value:
        """Vector in Earth-centred axes of unit length: of a place, or (`whole` off) of a direction."""
        sizes = A * np.array([1.0, 1.0, np.sqrt(1.0 - E2)])
        rows = self.axes.T / sizes[:, None]
        parts = [_dot(tree, vector, row) for row in rows]
        if whole:
            parts = [part + float(at) for part, at in zip(parts, self.origin / sizes, strict=True)]
        return tree.combine(*parts)

    def upward(self, tree: Tree, scaled: Value) -> tuple[Value, Value]:
        """Directions up by the ellipsoid's normal at a scaled place: Earth-centred, and in the scene."""
        polar = np.sqrt(1.0 - E2)
        up = tree.vector("NORMALIZE", tree.vector("MULTIPLY", scaled, (1.0, 1.0, float(1.0 / polar))))
        return up, tree.combine(*(_dot(tree, up, row) for row in self.axes))


def _dot(tree: Tree, vector: Value, row: np.ndarray) -> Value:
    return tree.vector("DOT_PRODUCT", vector, tuple(map(float, row)), name="Value")


def way(tree: Tree, here: Earth, height: float) -> Value:
    """Path length (m) from a surface to the camera, weighted by exp(-h / `height`)."""
    geometry = tree.node("ShaderNodeNewGeometry")
    scaled = here.scaled(tree, tree.pick(geometry, "Position"))
    above = (tree.vector("LENGTH", scaled, name="Value") - 1.0) * RADIUS
    _, up = here.upward(tree, scaled)
    rise = tree.vector("DOT_PRODUCT", up, tree.pick(geometry, "Incoming"), name="Value")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    return (above * (-1.0 / height)).exp() * weighted(tree, rise, distance, height)


def weighted(tree: Tree, rise: Value, distance: Value, height: float) -> Value:
    """Length (m) of a ray of slope cosine `rise` from height 0, weighted by exp(-h / `height`)."""
    bend = (1.0 - rise * rise) * (0.5 / (RADIUS * height))
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
    """Places 0 to 1 and weights of the quadrature."""
    at, weight = np.polynomial.legendre.leggauss(_NODES)
    return (0.5 * at + 0.5).tolist(), (0.5 * weight).tolist()


def eye(tree: Tree) -> Value:
    """Place of the camera in the scene, also for rays that end in the sky."""
    return tree.output(
        "ShaderNodeVectorTransform",
        {"Vector": (0.0, 0.0, 0.0)},
        vector_type="POINT",
        convert_from="CAMERA",
        convert_to="WORLD",
    )


def daylight(tree: Tree, up: Value, sun: Value) -> Value:
    """Daylight 0 to 1 at a place with this direction up: twilight while the sun is within 7 degrees."""
    return tree.vector("DOT_PRODUCT", up, sun, name="Value").smoothstep(-0.12, 0.12)
