"""Lit windows of buildings at night, by seed, in proportions that follow the hour (assumed)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...blender import nodes
from ...run import sun, times
from ...run.buildings import STOREY, Building
from ...shot.shot import Shot
from ...shot.terrain import noise
from ..light.build import light_keyframes
from ..light.keyframes import add_keyframes

LIT = "lit"
"""Attribute of faces: light of a lit window, black elsewhere."""
_SPACING, _WIDE, _HIGH, _SILL, _OUT = 3.2, 1.3, 1.2, 1.0, 0.04  # m, windows of a wall (assumed)
_DARK = 0.3  # share of buildings without any light (assumed)
_HOURS = (0.0, 1.0, 5.0, 6.5, 17.0, 22.0, 23.5, 24.0)  # mean solar time, h
_SHARES = (0.22, 0.10, 0.10, 0.30, 0.45, 0.45, 0.26, 0.22)  # of the windows, lit then (assumed)
_WARM, _COOL = (1.0, 0.60, 0.26), (0.78, 0.88, 1.0)  # colours of lamps
_COLD = 0.2  # share of the cool ones
_LIGHT = 0.6  # radiance at exposure 0: bright in the exposures of nights (by eye)
_DUSK = 1.0, -5.0  # degrees, solar elevations between which lights are switched on (assumed)

Array = NDArray[np.float64]


def shines(shot: Shot) -> bool:
    """Return True if the sun sets in the shot, so that windows may be lit."""
    _, states = light_keyframes(shot)
    return any(np.degrees(state.sky[0]) < _DUSK[0] for state in states)


def share(shot: Shot) -> float:
    """Return the share of windows that are lit at mid-shot."""
    moment = times.utc(shot.run, shot.frames.middle)
    hour = (moment.hour + moment.minute / 60.0 + sun.middle(shot.run)[1] / 15.0) % 24.0
    return float(np.interp(hour, _HOURS, _SHARES))


def lit_windows(building: Building, number: int, part: float, seed: int) -> tuple[Array, Array]:
    """Return lit windows of a building: faces (n, 4, 3), anticlockwise from outside, and colours (n, 3).

    `part` is the share of lit windows in all buildings; `number` and `seed` choose them.
    """
    if noise.uniform([number], [0], seed + 71)[0] < _DARK:
        return np.empty((0, 4, 3)), np.empty((0, 3))
    part = part / (1.0 - _DARK)
    ground = building.roof - building.footprint.height
    storeys = max(int(building.footprint.height / STOREY + 0.25), 1)
    corners = []
    for ring in building.footprint.rings:
        for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            length = float(np.hypot(*(end - start)))
            count = int((length - 1.0) / _SPACING)
            if count < 1:
                continue
            along = (end - start) / length
            at = 0.5 * length + (np.arange(count) - 0.5 * (count - 1)) * _SPACING
            floors = ground + np.arange(storeys) * STOREY + _SILL
            at, floors = (each.ravel() for each in np.meshgrid(at, floors))
            side = at[:, None] + np.array([-0.5, 0.5, 0.5, -0.5]) * _WIDE
            place = start + side[..., None] * along + _OUT * np.array([along[1], -along[0]])
            height = floors[:, None] + np.array([0.0, 0.0, 1.0, 1.0]) * _HIGH
            corners.append(np.concatenate([place, height[..., None]], axis=2))
    if not corners:
        return np.empty((0, 4, 3)), np.empty((0, 3))
    faces = np.concatenate(corners)
    index = np.arange(len(faces))
    chosen = noise.uniform(index, np.full(len(faces), number), seed + 72) < part
    lot = noise.uniform(index, np.full(len(faces), number), seed + 73)[chosen, None]
    bright = 0.5 + noise.uniform(index, np.full(len(faces), number), seed + 74)[chosen, None]
    return faces[chosen], np.where(lot < _COLD, _COOL, _WARM) * bright


def strength(tree: nodes.Tree, shot: Shot) -> nodes.Value:
    """Return the factor on `LIT` for rays of the camera, with keyframes at dusk and dawn."""
    frames, states = light_keyframes(shot)
    node = tree.node("ShaderNodeValue", name="Lights On")
    height = np.degrees([state.sky[0] for state in states])
    path = f'nodes["{node.name}"].outputs[0].default_value'
    add_keyframes(tree.node_tree, path, frames, noise.smoothstep(*_DUSK, height))
    bright = tree.input("Window Brightness", _LIGHT, "Radiance of lit windows at exposure 0", "Windows")
    return tree.pick(node) * bright * tree.output("ShaderNodeLightPath", name="Is Camera Ray")
