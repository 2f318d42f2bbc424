"""Flight paths of cameras: smooth geodesic legs, terrain clearance, banking and shake."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ..terrain import noise
from ..terrain.terrain import Terrain
from . import path
from .path import Array

_SAMPLE_SPACING = 5.0  # m between terrain samples along a path
_MAX_SAMPLES = 400_000  # samples at most
_STILL = 0.05  # m per frame; slower motion keeps its heading
_MAX_BANK = np.radians(60.0)  # largest bank angle


@dataclass(frozen=True)
class Waypoints:
    """Waypoints of a flight.

    Attributes
    ----------
    at
        (n,) time or parameter, ascending.
    latitude, longitude
        (n,) degrees.
    height
        (n,) m above the sea (the datum of the run's elevations), or above the ground.
    over_ground
        (n,) which of the heights are above the ground.
    """

    at: Array
    latitude: Array
    longitude: Array
    height: Array
    over_ground: NDArray[np.bool_]

    def flown(self, ground: Terrain, moments: Array) -> Array:
        """Positions (frames, 3), m in the scene, at times on the scale of `at`.

        Horizontal positions interpolate the chords between waypoints and are projected to the ellipsoid along
        its normal. A leg is thus a geodesic (a normal section is within millimetres of it over any run).
        Heights are interpolated separately.
        """
        frame = ground.frame
        above = ground.point(self.latitude, self.longitude, self.height)
        height = np.where(self.over_ground, frame.reverse(above)[2], self.height)
        chord = frame.forward(self.latitude, self.longitude, np.zeros(len(self.at)))
        inside = np.stack([path.smooth(self.at, chord[:, axis], moments) for axis in range(3)], axis=-1)
        latitude, longitude, _ = frame.reverse(inside)
        return frame.forward(latitude, longitude, path.smooth(self.at, height, moments))


def short(ground: Terrain, position: Array, clearance: Array) -> Array:
    """Height deficit (frames,), m: how much cameras must rise to keep their terrain clearance.

    Over 3D Tiles the clearance is above roofs and crowns. It holds between frames too: the path is straight
    there. A frame takes the largest deficit along its two adjacent legs. Between samples the terrain is
    assumed to rise by 1.5 times its difference from sample to sample.

    Parameters
    ----------
    position
        (frames, 3) m in the scene.
    clearance
        (frames,) required height above ground, m.
    """
    if len(position) == 1:
        return np.maximum(ground.top(*position.T[:2]) + clearance - position[:, 2], 0.0)
    length = np.linalg.norm(np.diff(position, axis=0), axis=1)
    apart = max(_SAMPLE_SPACING, float(length.sum()) / _MAX_SAMPLES)
    count = np.maximum(np.ceil(length / apart).astype(np.int64), 1) + 1  # with both ends of every leg
    first, leg = np.cumsum(count) - count, np.repeat(np.arange(len(count)), count)
    part = (np.arange(count.sum()) - first[leg]) / (count[leg] - 1.0)
    place = position[leg] + part[:, None] * (position[leg + 1] - position[leg])
    wanted = clearance[leg] + part * (clearance[leg + 1] - clearance[leg])
    up = ground.top(place[:, 0], place[:, 1])
    rise = 0.5 * np.abs(np.diff(up)) * (leg[1:] == leg[:-1])
    up = up + np.maximum(np.append(rise, 0.0), np.append(0.0, rise))
    needed = np.maximum(np.maximum.reduceat(up + wanted - place[:, 2], first), 0.0)
    return np.maximum(np.append(needed, 0.0), np.append(0.0, needed))


def heading(position: Array, still: float = _STILL) -> Array:
    """Heading (frames,), radians clockwise from north and unwrapped, along a path (frames, 3).

    A camera that moves by less than `still` m a frame keeps its last heading, or takes its next one; north if
    it never moves.
    """
    if len(position) == 1:
        return np.zeros(1)
    east, north = np.gradient(position[:, :2], axis=0).T
    moving = np.flatnonzero(np.hypot(east, north) > still)
    if len(moving) == 0:
        return np.zeros(len(position))
    before = np.searchsorted(moving, np.arange(len(position)), "right") - 1
    source = moving[np.maximum(before, 0)]
    return np.unwrap(np.arctan2(east[source], north[source]))


def ahead(position: Array, tilt: Array, distance: float = 1000.0) -> Array:
    """Look-at points (frames, 3) `distance` m ahead on a path, `tilt` degrees below the horizon."""
    bearing, down = heading(position), np.radians(tilt)
    flat = np.cos(down)
    along = np.stack([np.sin(bearing) * flat, np.cos(bearing) * flat, -np.sin(down)], axis=-1)
    return position + distance * along


def bank(position: Array, step: float) -> Array:
    """Bank angle (frames,), radians to the right, of an aircraft in a coordinated turn.

    tan(angle) = speed x turn rate / gravity, with `step` seconds between frames.
    """
    if len(position) < 3 or step <= 0.0:
        return np.zeros(len(position))
    speed = np.hypot(*np.gradient(position[:, :2], step, axis=0).T)
    turning = np.gradient(heading(position), step)
    return np.clip(np.arctan(speed * turning / constants.GRAVITY), -_MAX_BANK, _MAX_BANK)


def rolled(rotation: Array, angle: Array) -> Array:
    """Apply roll: rotations (frames, 3, 3) leaned to the right by angles (frames,), radians."""
    return rotation @ _about(2, -angle)


def trembling(rotation: Array, strength: float, seed: int, name: str) -> Array:
    """Camera shake: rotations (frames, 3, 3) disturbed about all three axes by normal deviates.

    Parameters
    ----------
    strength
        Standard deviation, degrees.
    seed, name
        Seeds of the deviates, with the frame number.
    """
    frame = np.arange(len(rotation))
    first = (seed + zlib.crc32(name.encode())) % 2**31
    for axis in range(3):
        deviate = noise.normal(*(noise.uniform(frame, axis, first + k) for k in (0, 1)))
        rotation = rotation @ _about(axis, np.radians(strength) * deviate)
    return rotation


def _about(axis: int, angle: Array) -> Array:
    """Rotation matrices (n, 3, 3) about an axis by angles (n,), counter-clockwise towards the viewer."""
    turn = np.repeat(np.eye(3)[None], len(angle), axis=0)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn[:, i, i] = turn[:, j, j] = np.cos(angle)
    turn[:, j, i], turn[:, i, j] = np.sin(angle), -np.sin(angle)
    return turn
