"""A step of the buoyant flow in vectorised NumPy: what someone would write without firetwin_core.

The same anelastic equations on the same staggered grid, float32: flux-form transport of scalars and
momentum, one direction after another in substeps below Courant number 0.8, limited in slope alike; heat and
smoke go in, buoyancy lifts, and the pressure is solved by real transforms along rows and columns and one
tridiagonal elimination along levels for all modes at once. It leaves out what would cost it more: the box is
periodic, and there are no eddies below the cells, no moisture, no terrain and no return to the air around.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

GRAVITY, REFERENCE = 9.80665, 300.0  # m/s2, K
COURANT = 0.8

Array = NDArray[np.float32]


@dataclass
class NumpyFlow:
    """Dry air over even ground. Arrays are (level, row, column); u, v, w are on cells' lower faces.

    Attributes
    ----------
    levels, density
        (nz + 1,) m from 0 up, and (nz,) kg/m3.
    spacing
        Edge of a square cell, m.
    ambient
        (nz,) K of the air around.
    fields
        A solver's `state`: u, v and w (m/s) on faces, of which the last is left out; theta, K above 300;
        smoke, kg/kg; age, that times s.
    heating, smoking
        (nz, ny, nx) K/s and 1/s that burn.
    """

    levels: NDArray[np.float64]
    density: NDArray[np.float64]
    spacing: float
    ambient: NDArray[np.float64]
    fields: dict[str, Array]
    heating: Array | None = None
    smoking: Array | None = None
    substeps: int = 0
    backwards: bool = False

    def __post_init__(self) -> None:
        """What does not change."""
        nz, *self.shape = self.fields["theta"].shape
        self.depth = np.diff(self.levels)
        self.rest = (self.ambient - REFERENCE).astype(np.float32)[:, None, None]
        self.cell = (self.density * self.depth).astype(np.float32)[:, None, None]  # kg/m2
        face = np.interp(self.levels[:-1], 0.5 * (self.levels[1:] + self.levels[:-1]), self.density)
        self.face = face.astype(np.float32)[:, None, None]  # kg/m3, of lower faces
        names = ("u", "v", "w", "theta", "smoke", "age")
        self.fields = {
            name: self.fields[name][:nz, : self.shape[0], : self.shape[1]].copy() for name in names
        }
        self._factor()

    def step(self, dt: float) -> None:
        """Go on by `dt` s."""
        self._carry(dt)
        self._burn(np.float32(dt))
        self._project()

    def divergence(self) -> float:
        """Largest |div(density x wind)| / density that is left, 1/s."""
        return float(np.abs(self._diverged() / self.cell).max())

    def mass(self) -> float:
        """Smoke in the air, kg."""
        return float(np.sum(self.fields["smoke"] * self.cell, dtype=np.float64)) * self.spacing**2

    def _carry(self, dt: float) -> None:
        fields = self.fields
        through = [  # kg per m2 of ground through lower faces along z, y, x
            fields["w"] * self.face,
            fields["v"] * (self.cell / np.float32(self.spacing)),
            fields["u"] * (self.cell / np.float32(self.spacing)),
        ]
        most = max(float(np.abs(each / self.cell).max()) for each in through) * dt
        self.substeps = max(1, int(np.ceil(most / COURANT)))
        part = np.float32(dt / self.substeps)
        through = [each * part for each in through]
        order = (0, 1, 2) if self.backwards else (2, 1, 0)
        self.backwards = not self.backwards
        # Momentum in cells' middles; its change goes back to the faces.
        middle = {name: _upward(fields[name], axis) for name, axis in (("w", 0), ("v", 1), ("u", 2))}
        before = {name: values.copy() for name, values in middle.items()}
        carried = {name: fields[name] for name in ("theta", "smoke", "age")} | middle
        for _ in range(self.substeps):
            mass = np.broadcast_to(self.cell, carried["theta"].shape)
            for axis in order:
                flux = through[axis]
                after = mass - _outward(flux, axis)
                for name, values in carried.items():
                    carried[name] = (
                        mass * values - _outward(_limited(flux, mass, values, axis), axis)
                    ) / after
                mass = after
        for name, axis in (("w", 0), ("v", 1), ("u", 2)):
            change = carried.pop(name) - before[name]
            fields[name] = fields[name] + np.float32(0.5) * (change + np.roll(change, 1, axis))
        fields["w"][0] = 0.0
        fields |= carried

    def _burn(self, dt: np.float32) -> None:
        fields = self.fields
        fields["age"] += fields["smoke"] * dt
        if self.heating is not None:
            fields["theta"] += self.heating * dt
            fields["smoke"] += self.smoking * dt
        force = (fields["theta"] - self.rest) * (np.float32(GRAVITY) / (self.rest + np.float32(REFERENCE)))
        fields["w"][1:] += (force[1:] + force[:-1]) * (np.float32(0.5) * dt)

    def _diverged(self) -> Array:
        """What leaves each cell, kg/m2/s."""
        along = self.cell / np.float32(self.spacing)
        out = _outward(self.fields["u"] * along, 2)
        out += _outward(self.fields["v"] * along, 1)
        return out + _outward(self.fields["w"] * self.face, 0)

    def _factor(self) -> None:
        """Pivots of the elimination along levels, for every mode of rows and columns."""
        nz, (ny, nx) = len(self.density), self.shape
        wave = [2.0 - 2.0 * np.cos(2.0 * np.pi * np.arange(n) / m) for n, m in ((ny, ny), (nx // 2 + 1, nx))]
        wave = (wave[0][:, None] + wave[1]) / self.spacing**2
        gap = 0.5 * (self.depth[1:] + self.depth[:-1])
        link = np.zeros(nz + 1)
        link[1:-1] = self.face[1:, 0, 0] / gap
        self.link = link.astype(np.float32)
        self.pivot = np.empty((nz, *wave.shape), np.float32)
        below = 0.0
        for k in range(nz):
            middle = -self.cell[k, 0, 0] * wave - link[k] - link[k + 1] - below
            if k == nz - 1:
                middle[0, 0] -= link[k]  # the mean pressure is free
            self.pivot[k] = 1.0 / middle
            below = link[k + 1] ** 2 * self.pivot[k]

    def _project(self) -> None:
        modes = np.fft.rfft2(self._diverged(), axes=(1, 2)).astype(np.complex64, copy=False)
        modes[0] *= self.pivot[0]
        for k in range(1, len(modes)):
            modes[k] = (modes[k] - self.link[k] * modes[k - 1]) * self.pivot[k]
        for k in range(len(modes) - 2, -1, -1):
            modes[k] -= self.pivot[k] * self.link[k + 1] * modes[k + 1]
        pressure = np.fft.irfft2(modes, s=self.shape, axes=(1, 2)).astype(np.float32, copy=False)
        for name, axis in (("v", 1), ("u", 2)):
            self.fields[name] -= (pressure - np.roll(pressure, 1, axis)) / np.float32(self.spacing)
        gap = (0.5 * (self.depth[1:] + self.depth[:-1])).astype(np.float32)[:, None, None]
        self.fields["w"][1:] -= (pressure[1:] - pressure[:-1]) / gap


def _upward(values: Array, axis: int) -> Array:
    """Means of cells' lower and upper faces; the lid's is 0 as the ground's is."""
    return np.float32(0.5) * (values + np.roll(values, -1, axis))


def _outward(flux: Array, axis: int) -> Array:
    """What leaves cells less what enters, from what goes through their lower faces."""
    return np.roll(flux, -1, axis) - flux


def _limited(flux: Array, mass: Array, q: Array, axis: int) -> Array:
    """What a flux through lower faces carries: the third-order slope, limited (Koren 1993)."""
    up = flux > 0
    behind = np.roll(q, 1, axis)
    here, ahead = np.where(up, behind, q), np.where(up, q, behind)
    before = np.where(up, np.roll(behind, 1, axis), np.roll(q, -1, axis))
    share = np.minimum(np.abs(flux) / np.where(up, np.roll(mass, 1, axis), mass), np.float32(1))
    a, b = ahead - here, here - before
    third = ((2 - share) * np.abs(a) + (1 + share) * np.abs(b)) * np.float32(1 / 3)
    size = np.minimum(np.float32(2) * np.minimum(np.abs(a), np.abs(b)), third)
    slope = np.where(a * b > 0, np.copysign(size, a), np.float32(0))
    return flux * (here + np.float32(0.5) * (1 - share) * slope)
