"""Scene content of an export: the built scene as arrays, without Blender. `read_scene` fills it.

Positions are in metres in the scene's local frame: x east, y north, z up. Colours are linear Rec. 709.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..geometry.camera_track import CameraTrack

Array = NDArray[np.float64]
Floats = NDArray[np.float32]
Numbers = NDArray[np.int64]

LOOKS = ("foliage", "bark", "char", "rock", "grass")
"""Kinds of surface of prototypes."""

_RISING, _OWN = (0.05, 0.04), 0.55  # rise of a crown's normals, and weight of a leaf's own normal


@dataclass(frozen=True)
class Prototype:
    """A plant model in one level of detail, one metre tall, with its foot at the origin.

    Attributes
    ----------
    name
        Unique name, such as ``large_00_living_level1``.
    kind
        Class of the model, such as "large" or "brush" (`scene.forest.models.KINDS`), or "grass".
    state
        "living" or "snag", which is burned.
    level
        Level of detail, 0 (near) to 3 (far).
    points, triangles
        (n, 3) m, and (m, 3) point indices, anticlockwise seen from outside.
    colours
        (m, 3) reflectance of each triangle.
    looks
        (m,) index in `LOOKS` of each triangle.
    """

    name: str
    kind: str
    state: str
    level: int
    points: Floats
    triangles: Numbers
    colours: Floats
    looks: Numbers

    def shading_normals(self) -> Floats:
        """Return unit normals (m, 3) of the triangles; in foliage they point away from the trunk.

        Crowns then have a sunlit and a shaded side, as in `scene.forest.material`.
        """
        a, b, c = (self.points[self.triangles[:, corner]].astype(np.float64) for corner in range(3))
        flat = _unit(np.cross(b - a, c - a))
        middle = (a + b + c) / 3.0
        outward = _unit(middle * (1.0, 1.0, _RISING[1]) + (0.0, 0.0, _RISING[0]))
        rounded = _unit(outward + _OWN * flat)
        return np.where((self.looks == 0)[:, None], rounded, flat).astype(np.float32)


def _unit(vector: Array) -> Array:
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.where(length > 0.0, vector / np.maximum(length, 1.0e-30), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Plants:
    """Instances of prototypes, n of them: trees, the understorey or grass.

    Attributes
    ----------
    name
        "Trees", "Understorey" or "Grass".
    position
        (n, 3) m, foot of the plant.
    rotation
        (n, 4) unit quaternions w, x, y, z.
    scale
        (n, 3) factors on the prototype; the third is the height in m.
    ids
        (n,) tree numbers of the pass `masks`; None for plants without numbers. Two of n trees can have the
        same number (about n^2 / 2^25 pairs).
    prototype, burned_prototype
        (n,) index in `SceneContent.prototypes` before and after the fire.
    burned_from
        (n,) model time (s) from which the burned prototype is shown; infinite without fire.
    arrival
        (n,) model time (s) at which the fire arrives; infinite without fire.
    scorch, torched
        (n,) scorch height over height, 0..1, and 1 for burning crowns.
    """

    name: str
    position: Floats
    rotation: Floats
    scale: Floats
    ids: Numbers | None
    prototype: Numbers
    burned_prototype: Numbers
    burned_from: Floats
    arrival: Floats
    scorch: Floats
    torched: Floats

    @property
    def height(self) -> Floats:
        """Heights (n,), m."""
        return self.scale[:, 2]

    def in_flames(self, time: float) -> NDArray[np.bool_]:
        """Return which crowns (n,) are in flames at a model time (s): from the fire to the bare plant."""
        return (self.torched > 0.5) & (self.arrival <= time) & (time < self.burned_from)


@dataclass(frozen=True)
class TerrainMesh:
    """Ground of the scene: (n, 3) points, m; (m, 3) triangles; (n, 3) normals; (n, 2) texture coordinates.

    The first texture coordinate grows to the east, the second to the north.
    """

    points: Floats
    triangles: Numbers
    normals: Floats
    uv: Floats


@dataclass(frozen=True)
class FlamePoints:
    """Flames, n of them; a flame is lit while 0 <= t - arrival < residence.

    Attributes
    ----------
    position
        (n, 3) m, foot of the flame.
    arrival, residence
        (n,) s.
    length, width
        (n,) full size, m.
    tilt
        (n,) angle from the vertical, radians, towards `wind`.
    kelvin
        (n,) temperature.
    intensity
        (n,) fireline intensity, kW/m.
    seed
        (n,) 0..1.
    wind
        (2,) m/s east and north.
    """

    position: Floats
    arrival: Floats
    residence: Floats
    length: Floats
    width: Floats
    tilt: Floats
    kelvin: Floats
    intensity: Floats
    seed: Floats
    wind: tuple[float, float]

    def lit(self, time: float) -> Numbers:
        """Return the indices of the flames that are lit at a model time (s)."""
        age = time - self.arrival
        return np.flatnonzero((age >= 0.0) & (age < self.residence))


@dataclass(frozen=True)
class SmokeLayer:
    """Smoke volumes of one layer.

    Attributes
    ----------
    name
        Name of the layer.
    files
        OpenVDB file of each frame.
    temperature
        OpenVDB file with the temperature of each frame, if `files` have none.
    """

    name: str
    files: dict[int, Path] = field(default_factory=dict)
    temperature: dict[int, Path] = field(default_factory=dict)


@dataclass(frozen=True)
class SceneContent:
    """Everything that needs the built scene.

    Attributes
    ----------
    frames
        (f,) exported frames, from 1.
    times
        (f,) their model times, s.
    rate
        Frames per second of the film.
    """

    frames: Numbers
    times: Array
    rate: float
    terrain: TerrainMesh | None
    prototypes: list[Prototype]
    plants: list[Plants]
    flames: FlamePoints | None
    cameras: list[CameraTrack]
    smoke: list[SmokeLayer]
