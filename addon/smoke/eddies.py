"""Eddies below the resolution of a flow: they displace its smoke. Needs no Blender.

The thermals of a solved flow are round, as its cells smear the eddies at their sides. From above they are
balls of one size. The displacement is a sum of transverse waves, which neither compresses nor thins smoke
("kinematic simulation", J. C. H. Fung et al. 1992, J. Fluid Mech. 236). It travels with the air, in the two
phases of the drift, and grows with the height above ground.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..geometry.grids import dilate
from .domains import Domain
from .snapshots import Snapshot

_WAVES = 11.0, 7.5, 5.0, 3.4  # cells of the outer domain, wavelengths (by eye)
_EACH = 4  # waves of each length, in random directions
_SHARE = 0.08  # amplitude of a wave over its length (by eye)
_HEIGHT = 4.0  # cells of the outer domain, height above which the displacement is complete (by eye)
_REACH = 4.0  # cells of the outer domain, largest displacement: over two standard deviations
_MOVED = "smoke", "age", "rise", "temperature_excess"
_VISIBLE = 1.0e-9  # kg/m3; thinner smoke is displaced near visible smoke only
_LEAST_WEIGHT = 0.02  # of a phase of the drift, as in `flow.Detail`

Array = NDArray[np.float32]


def displace(snapshot: Snapshot, domain: Domain, seed: int) -> Snapshot:
    """Return a snapshot of a domain with its smoke displaced by eddies."""
    fields, box, size = snapshot.fields, domain.box, domain.scale.cell
    there = dilate(fields["smoke"] > _VISIBLE, round(_REACH * size / box.spacing), beyond=False)
    k, j, i = np.nonzero(there)
    levels = np.array(box.levels)
    middles = 0.5 * (levels[1:] + levels[:-1])
    first = (np.array(box.corner) / box.spacing + np.array(snapshot.low) + 0.5) * box.spacing
    place = [i * box.spacing + first[0], j * box.spacing + first[1], middles[k]]
    shift = np.zeros((3, len(k)), np.float32)
    for phase, weight in enumerate(snapshot.weights):
        if weight > _LEAST_WEIGHT:
            drift = fields["drift"][k, j, i, phase].T
            origin = np.array([(at - moved) / size for at, moved in zip(place, drift, strict=True)])
            shift += np.float32(weight) * waves(
                origin.astype(np.float32), (seed, phase, snapshot.turns[phase])
            )
    shift = np.clip(shift, -_REACH, _REACH) * (size * np.minimum(middles / (_HEIGHT * size), 1.0))[k]
    depth = np.diff(levels)[k]
    source = k - shift[2] / depth, j - shift[1] / box.spacing, i - shift[0] / box.spacing
    moved = {name: fields[name].copy() for name in _MOVED}
    for name, values in zip(_MOVED, _sampled([fields[name] for name in _MOVED], source), strict=True):
        moved[name][there] = values
    return replace(snapshot, fields=fields | moved)


def waves(place: Array, key: tuple[int, int, int]) -> Array:
    """Return the displacement (3, n) at places (3, n), both in cells of the outer domain."""
    random = np.random.default_rng([abs(part) for part in key])
    velocity = np.zeros_like(place)
    for length in np.repeat(_WAVES, _EACH):
        along, across = random.normal(size=(2, 3))
        along /= np.linalg.norm(along)
        across -= along * (across @ along)
        across *= _SHARE * length / np.linalg.norm(across)
        x, y, z = (2.0 * np.pi / length * along).astype(np.float32)
        wave = np.sin(
            x * place[0] + y * place[1] + z * place[2] + np.float32(random.uniform(0.0, 2.0 * np.pi))
        )
        for axis in range(3):
            velocity[axis] += np.float32(across[axis]) * wave
    return velocity


def _sampled(fields: list[Array], at: tuple[NDArray, NDArray, NDArray]) -> list[Array]:
    """Interpolate fields (nz, ny, nx) linearly at fractional indices (n,) along each axis."""
    sides = []
    for index, count in zip(at, fields[0].shape, strict=True):
        held = np.clip(index, 0.0, count - 1.0)
        low = held.astype(np.int32)
        part = (held - low).astype(np.float32)
        sides.append(((low, 1.0 - part), (np.minimum(low + 1, count - 1), part)))
    sums = [np.zeros(len(at[0]), np.float32) for _ in fields]
    _, rows, columns = fields[0].shape
    for z, by_z in sides[0]:
        for y, by_y in sides[1]:
            row, weight = (z * rows + y) * columns, by_z * by_y
            for x, by_x in sides[2]:
                for values, field in zip(sums, fields, strict=True):
                    values += weight * by_x * field.ravel()[row + x]
    return sums
