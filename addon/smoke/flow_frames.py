"""Flow frames: paint snapshots of a solved flow, with subgrid detail, into OpenVDB files. Needs no Blender.

A frame has one file, or two: the nested domain, and the rest with larger voxels. The two are blended at their
border. The grids are: `density`, extinction in 1/m; `fresh`, 1 for young and 0 for aged smoke; `sun` and
`sky`, transmittance of their light, see `LIGHT`; `hidden`, 1 for smoke occluded by other smoke in all views,
see `DEEP`; `glow`, light of flames in the dark, 1 among flames of 1 GW.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core import flow, lod, volume
from numpy.typing import NDArray

from ..run import sun
from ..shot.cameras.path import SENSOR
from ..shot.fire.smoke_scale import Scale
from ..shot.shot import WIDE_LENS, Shot
from ..shot.terrain import noise
from . import eddies, flame_light, snapshots, tones, windward
from .close_up import Window
from .domains import Box, Domain
from .flow import Flow

GRIDS = ("density", "fresh", "sun", "sky", "hidden", "glow")
"""Grids of a volume, all of one voxel size. `sky` on voxels twice as large would save 10 of 40 MB, but Cycles
4.5 offsets each grid by half of its voxel size, and took 12.6 instead of 10.3 processor seconds for a
picture.
"""
LIGHT = 0.65 / 4, 0.5
"""Factors on the optical depth for `sun` and `sky`. Forward-scattered light counts as unscattered: 0.36 of
0.86 to 0.95 for an asymmetry of 0.6 (Joseph, Wiscombe and Weinman 1976); 0.65 remains. `sun` is the fourth
root of the transmittance, which half floats resolve up to four times the optical depth.
"""
_ASYMMETRY = 0.6  # of scattering (Reid et al. 2005: 0.5 to 0.65 in green light)
DEEP = 6.0  # optical depth beyond which smoke is `hidden`: transmittance is 0.25 %
_MAX_EXTINCTION = 0.03  # 1/m, upper limit; denser smoke would look equally opaque but need shorter steps
_NEAR = (20.0, 36.0)  # m, smallest and largest voxels of the nest
_PIXELS = 4.0  # pixels per voxel between these limits: finer smoke costs more without visible detail
_FAR = 80.0  # m, voxels outside of the nest
_UNNESTED = 60.0  # m, smallest voxels without a nest
_NOISE = {True: (340.0, (3.5, 2.5, 2.5)), False: (1100.0, (2.5, 1.5, 1.5))}  # m; blur of the drift, cells
_SURFACE_STEP = 40.0  # m
_INSIDE, _FADE = 600.0, (700.0, 4000.0)  # m from a box's side: where smoke ends, and range of its fade
# Ragged ends of smoke: amplitude as a share of the fade, size (m), and steepness at the side.
_RAGGEDNESS, _RAGGED_SIZE, _EDGE = 0.8, 6000.0, 1.4
_THINNING = 6  # exponent of the fade at the far end: dense smoke is opaque down to a hundredth
_MIN_DENSITY = 1e-9  # kg/m3; thinner smoke is skipped
_MIN_EXTINCTION = 5.0e-5  # 1/m; thinner smoke is not stored
_AGES = 20.0, 600.0  # s, ages between which smoke turns from dark to white
_BLOCK, _ROUND = 16, 300.0  # voxels of a culling block; m of margin for multiply scattered light

# Lengths, times and extinctions apply to a fire on cells of `smoke_scale.REFERENCE` m.

Array = NDArray[np.float64]
Brick = tuple[NDArray[np.float32], float, list[float]]
"""Values (nx, ny, nz), voxel size and centre of the first voxel (m), as in `volume.occluded_smoke`."""
Eyes = tuple[Array, Array]
"""Viewpoints, as returned by `Visibility.eyes`."""


@dataclass(frozen=True)
class OuterLayer:
    """Outer layer's effect on the next: optical depth to its lights, and occluding extinction (1/m)."""

    depths: volume.LightDepths | None = None
    smoke: Brick | None = None


@dataclass(frozen=True)
class _PaintedLayer:
    """Painted layer: smoke with its light, blend weight of columns (nx, ny), and the flow's masses (kg)."""

    lit: volume.LitSmoke
    share: Array
    origin: tuple[float, float, float]
    mass: dict[str, float]


@dataclass(frozen=True)
class Layer:
    """Volume layer: a domain's smoke on voxels of one size (m), in files of one name."""

    name: str
    domain: Domain
    voxel: float
    fine: bool
    close: bool = False
    """Draw only the part within a frame's close-up window."""
    ground_step: float = 0.0
    """Spacing of samples of the true ground, m; 0: by the scale."""

    def file(self, folder: Path, frame: int) -> Path:
        """Volume file of a frame."""
        return folder / f"{self.name}_{frame:06d}.vdb"


def layers(shot: Shot, solved: Flow) -> list[Layer]:
    """List the volume layers of a shot's smoke. The last one is named "smoke" and is written last."""
    domains = solved.domains
    if not domains:
        return []
    wanted, length = shot.settings.smoke.voxel_size, shot.scale.length
    far = length(_FAR)
    if len(domains) == 1:
        near = min(max(_PIXELS * _pixel(shot), length(_UNNESTED)), far)
        return [Layer("smoke", domains[0], wanted or near, False)]
    least, most = map(length, _NEAR)
    near = float(np.clip(_PIXELS * _pixel(shot), least, most))
    return [
        Layer("far", domains[0], max(wanted, far), False),
        Layer("smoke", domains[1], wanted or near, True),
    ]


def _pixel(shot: Shot) -> float:
    """Return the smallest pixel size (m) at the fire."""
    plain = SENSOR / WIDE_LENS / shot.settings.render.resolution[0]  # without a perspective camera
    return shot.fire_distance * (shot.pixel[0] if shot.perspective_paths else plain)


def max_extinction(scale: Scale) -> float:
    """Return the extinction (1/m) at which smoke saturates."""
    return _MAX_EXTINCTION / scale.ratio


def diffusion_exponent(albedo: float) -> float:
    """Return the factor on the optical depth of thick smoke by which light in it falls off.

    It is the diffusion approximation for a single-scattering albedo (H. C. van de Hulst 1980, "Multiple Light
    Scattering").
    """
    return float(np.sqrt(3.0 * (1.0 - albedo) * (1.0 - _ASYMMETRY * albedo)))


def min_extinction(scale: Scale) -> float:
    """Return the extinction (1/m) below which smoke is not stored."""
    return _MIN_EXTINCTION / scale.ratio


class Painter:
    """Paints and writes the volumes of one layer.

    Parameters
    ----------
    inner
        Box of a finer layer, which is excluded.
    """

    def __init__(self, shot: Shot, layer: Layer, inner: Box | None) -> None:
        self.shot, self.layer, self.inner = shot, layer, inner
        self.scale = layer.domain.scale
        self._thin = min_extinction(self.scale)

    def write(
        self,
        path: Path,
        frame: int,
        lights: tuple[Array, Array] | None,
        views: lod.ViewSet | None,
        metadata: dict[str, str],
        eyes: Eyes | None = None,
        beyond: OuterLayer | None = None,
    ) -> tuple[volume.VdbSummary, OuterLayer]:
        """Write a frame's volume, culled to visible blocks.

        Parameters
        ----------
        lights
            Positions (n, 3), m, and powers (n,), W, of flames; None: no glow.
        eyes
            Viewpoints of the frame; None: no smoke is occluded.
        beyond
            The outer layer around this one.

        Returns
        -------
        Summary of the file, and this layer's effect on the next. Smoke that is not drawn attenuates sunlight
        as well.
        """
        painted = self._paint(frame, lights, views, beyond)
        voxel, origin = self.layer.voxel, painted.origin
        grids = painted.lit.grids(painted.share, self._thin)
        smoke = None
        if eyes is not None:
            outer = beyond.smoke if beyond else None
            grids["hidden"], smoke = volume.occluded_smoke(
                grids["density"], voxel, *eyes, DEEP, origin, outer
            )
        written = volume.write(
            path,
            grids,
            voxel,
            origin,
            tolerance=1e-6,
            metadata=metadata | {f"smoke_{name}_kg": f"{value:.9g}" for name, value in painted.mass.items()},
            views=views,
            within="density",
        )
        return written, OuterLayer(painted.lit.depths, smoke)

    def bricks(
        self,
        frame: int,
        lights: tuple[Array, Array] | None,
        views: lod.ViewSet | None,
        beyond: OuterLayer | None = None,
        window: Window | None = None,
    ) -> tuple[volume.Bricks, OuterLayer]:
        """Paint a frame as bricks for ray marching, without a file.

        Parameters
        ----------
        window
            Close-up window that is painted again on finer voxels.
        """
        painted = self._paint(frame, lights, views, beyond, window)
        return painted.lit.bricks(painted.share, self._thin), OuterLayer(painted.lit.depths)

    def _paint(
        self,
        frame: int,
        lights: tuple[Array, Array] | None,
        views: lod.ViewSet | None,
        beyond: OuterLayer | None,
        window: Window | None = None,
    ) -> _PaintedLayer:
        domain, seed = self.layer.domain, self.shot.settings.seed
        snapshot = eddies.displace(snapshots.load(domain.snapshot_path(frame)), domain, seed)
        voxel = self.layer.voxel
        origin, surface, end, share, count = self._brick(snapshot, window)
        wanted = _visible_blocks(views, origin, (*surface.shape, count), voxel, self.scale.length(_ROUND))
        time = float(self.shot.frames.times[frame - 1])
        smoke = self._detail(snapshot, lights, time).paint_sparse(
            origin,
            voxel,
            surface,
            end,
            count,
            wanted,
            self._thin,
            self._log_gain(snapshot, time, origin, surface.shape),
            self._lean,
            self.scale.length(windward.HEIGHT),
        )
        smoke.dim_glow(diffusion_exponent(self.shot.fire.smoke.white))
        toward = sun.toward_light(self.shot.run, time)
        lit = volume.LitSmoke(smoke, toward.tolist(), *LIGHT, beyond.depths if beyond else None)
        return _PaintedLayer(lit, share, origin, snapshot.mass)

    def _log_gain(
        self, snapshot: snapshots.Snapshot, time: float, origin: tuple[float, ...], shape: tuple[int, ...]
    ) -> Array | None:
        """Return the logarithm of a factor (nx, ny) on smoke at the ground, see `windward`."""
        if not self.layer.fine:
            return None
        box, voxel = self.layer.domain.box, self.layer.voxel
        x, y = (low + np.arange(count) * voxel for low, count in zip(origin, shape, strict=False))
        places = windward.find_sources(self.shot, time, x, y)
        gain = windward.log_gain(places, voxel, self.scale, box.spacing, self.shot.wind)
        if gain is None:
            return None
        corner = [low + (at + 0.5) * box.spacing for low, at in zip(box.corner, snapshot.low, strict=True)]
        age = snapshot.fields["age"][: windward.LEVELS].mean(axis=0).T.astype(np.float64)
        share = windward.local_share(age, self.scale.time(1.0))
        return gain * _sampled(share, box.spacing, (corner[0], corner[1]), x, y)

    @property
    def _lean(self) -> tuple[float, float]:
        """Return the horizontal shift of rising smoke over its height."""
        east, north = self.shot.wind
        factor = windward.LEAN / max(float(np.hypot(east, north)), 1.0e-6)
        return factor * east, factor * north

    @functools.cached_property
    def _heights(self) -> Array:
        """Return heights of the ground and of cell centres (1 + nz, rows, columns), m, as in the solver."""
        return np.concatenate([self.layer.domain.ground[None], self.layer.domain.heights()])

    def _brick(
        self, snapshot: snapshots.Snapshot, window: Window | None
    ) -> tuple[tuple[float, float, float], Array, Array, Array, int]:
        """Return the first voxel's centre, ground heights, the weights of `_shares`, and number of levels."""
        box, voxel = self.layer.domain.box, self.layer.voxel
        _nz, rows, columns = snapshot.fields["smoke"].shape
        low = np.array(box.corner) + np.array(snapshot.low) * box.spacing
        last = low + np.array([columns, rows]) * box.spacing
        if self.layer.close and window is not None:
            low, last = np.clip([window.low, window.high], low, last)
        first = np.floor(low / voxel) * voxel
        nx, ny = (max(2, int(np.ceil(side / voxel))) for side in last - first)
        x, y = first[0] + np.arange(nx) * voxel, first[1] + np.arange(ny) * voxel
        surface = _sampled(self._surface, self._surface_step, box.corner, x, y)
        heights = self._heights[1:, snapshot.low[1] : snapshot.low[1] + rows, snapshot.low[0] :][
            :, :, :columns
        ]
        seen = snapshot.fields["smoke"] > _MIN_DENSITY
        lowest = float(surface.min())
        base = np.floor(lowest / voxel) * voxel
        top = float(heights[: len(seen)][seen].max(initial=lowest)) + 2.0 * box.spacing
        origin = (float(first[0]), float(first[1]), float(base))
        end, share = self._shares(x[:, None], y[None, :], window)
        return origin, surface, end, share, max(2, int((top - base) / voxel))

    @property
    def _surface_step(self) -> float:
        """Return the spacing of samples of the true ground, m."""
        return self.layer.ground_step or self.scale.length(_SURFACE_STEP)

    @functools.cached_property
    def _surface(self) -> Array:
        """Return true ground heights over the box (nx, ny) every `_surface_step` m."""
        box = self.layer.domain.box
        x, y = (
            np.arange(low, high + self._surface_step, self._surface_step)
            for low, high in zip(box.corner, box.high, strict=True)
        )
        up = self.shot.bare_ground.up(np.repeat(x, len(y)), np.tile(y, len(x)))
        return up.reshape(len(x), len(y))

    def _shares(self, x: Array, y: Array, window: Window | None = None) -> tuple[Array, Array]:
        """Return weights 0..1 at points: smoke that attenuates light, and share of it that is drawn."""
        box = self.layer.domain.box
        if self.layer.fine:
            close = 0.0 if window is None else window.share(x, y)
            drawn = self._inside(box, x, y, _FADE[0])
            return np.ones((x + y).shape), drawn * (close if self.layer.close else 1.0 - close)
        torn = _RAGGEDNESS * noise.fractal(
            x, y, self.scale.length(_RAGGED_SIZE), 6, self.shot.settings.seed, 0.6
        )
        end = self._inside(box, x, y, _FADE[1], torn) ** _THINNING
        return end, np.ones_like(end) if self.inner is None else 1.0 - self._inside(
            self.inner, x, y, _FADE[0]
        )

    def _inside(self, box: Box, x: Array, y: Array, fade: float, torn: Array | float = 0.0) -> Array:
        """Fade a box from 0 outside and near its sides to 1 deeper than `fade`; `torn` offsets the depth."""
        low, high = box.corner, box.high
        depth = np.minimum(np.minimum(x - low[0], high[0] - x), np.minimum(y - low[1], high[1] - y))
        way = (depth - self.scale.length(_INSIDE)) / self.scale.length(fade)
        return np.clip(np.minimum(way + torn, _EDGE * way), 0.0, 1.0)

    def _detail(
        self, snapshot: snapshots.Snapshot, lights: tuple[Array, Array] | None, time: float
    ) -> flow.Detail:
        box, shot = self.layer.domain.box, self.shot
        nz, rows, columns = snapshot.fields["smoke"].shape
        west, south = snapshot.low
        heights = self._heights[: nz + 1, south : south + rows, west : west + columns]
        corner = box.corner[0] + west * box.spacing, box.corner[1] + south * box.spacing
        size, blur = _NOISE[self.layer.fine]
        mix = shot.fire.smoke
        # Thresholds are for a crown fire's smoke; they are lower for thinner smoke of equal temperature.
        scale = self.layer.domain.scale
        ages = scale.time(_AGES[0]), scale.time(_AGES[1])
        fields = snapshot.fields | {
            "smoke": snapshot.fields["smoke"] / np.float32(mix.dilution),
            "age": tones.apparent_age(shot, time, snapshot.fields["age"], corner, box.spacing, ages),
        }
        levels = np.array(box.levels)
        return flow.Detail(
            **fields,
            spacing=box.spacing,
            corner=corner,
            levels=0.5 * (levels[1:] + levels[:-1])[:nz],
            heights=heights[1:],
            ground=heights[0],
            weights=snapshot.weights,
            turns=snapshot.turns,
            glow=None
            if lights is None
            else flame_light.glow(lights, heights[1:], box.spacing, corner, scale),
            size=scale.length(size),
            scale=scale.ratio,
            blur=blur,
            opacity=mix.opacity,
            condensation_height=shot.settings.smoke.cloud_base,
            max_extinction=max_extinction(scale),
            ages=ages,
            seed=shot.settings.seed,
        )


def _visible_blocks(
    views: lod.ViewSet | None,
    origin: tuple[float, float, float],
    shape: tuple[int, ...],
    voxel: float,
    around: float,
) -> NDArray[np.bool_] | None:
    """Return the mask of visible blocks of a grid. `volume.write` excludes the other blocks."""
    if views is None:
        return None
    side = _BLOCK * voxel
    blocks = tuple(-(-count // _BLOCK) for count in shape)
    number = np.moveaxis(np.indices(blocks), 0, -1).reshape(-1, 3)
    place = number * side + origin + 0.5 * (side - voxel)
    radius = 0.5 * np.sqrt(3.0) * side + around
    return lod.visible_mask(place, np.full(len(place), radius), views, shadows=True).reshape(blocks)


def _sampled(values: Array, step: float, corner: tuple[float, float], x: Array, y: Array) -> Array:
    """Interpolate values (nx, ny), every `step` m from a corner, linearly at points x and y."""
    i, j = ((at - low) / step for at, low in zip((x, y), corner, strict=True))
    i, j = (np.clip(at, 0.0, count - 1.001) for at, count in zip((i, j), values.shape, strict=True))
    a, b = i.astype(np.int64), j.astype(np.int64)
    u, v = (i - a)[:, None], (j - b)[None, :]
    corners = [values[np.ix_(a + e, b + n)] for e in (0, 1) for n in (0, 1)]
    return (corners[0] * (1 - v) + corners[1] * v) * (1 - u) + (corners[2] * (1 - v) + corners[3] * v) * u
