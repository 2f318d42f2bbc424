"""Selection of the tiles of a shot: one for all frames, independent of their order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from firetwin_core import lod, tiles
from numpy.typing import ArrayLike, NDArray

from ..progress import Progress, silent
from . import horizon
from .loader import Loader
from .tree import MODEL
from .volumes import Volumes


@dataclass(frozen=True)
class Views:
    """Every view of every frame of a shot.

    Attributes
    ----------
    view_set
        m views, in the scene.
    pixels
        (m,) pixels of 1 m at a distance of 1 m in the picture's centre (see `pixels`). Orthographic: pixels
        of 1 m.
    eyes
        (k, 3) places of the perspective cameras, m.
    horizon
        (4, 4) from Earth-centred metres to the scene, for horizon culling: tiles behind the Earth for all
        eyes are not visible. None: no horizon culling, as for orthographic cameras, which have no eyes.
    """

    view_set: lod.ViewSet
    pixels: NDArray[np.float64]
    eyes: NDArray[np.float64]
    horizon: NDArray[np.float64] | None = None


def pixels(height: ArrayLike, half_height: ArrayLike) -> NDArray[np.float64]:
    """Compute `Views.pixels` of pictures with `height` pixels.

    Parameters
    ----------
    half_height
        Perspective: tangent of half the vertical angle of view. Orthographic: half the height, m.
    """
    return np.asarray(height, float) / (2.0 * np.asarray(half_height, float))


@dataclass(frozen=True)
class Budget:
    """Limits on tiles, bytes and triangles of a selection; None: no limit."""

    tiles: int | None = None
    bytes: int | None = None
    triangles: int | None = None


@dataclass(frozen=True)
class TileSelection:
    """The tiles of a shot.

    Attributes
    ----------
    tiles
        (n,) numbers in the tree, ascending.
    contents
        (k,) numbers of their contents, ascending.
    error
        Screen-space error above which tiles are refined, pixels.
    requested_error
        Requested screen-space error, pixels; less than `error` if the budget does not suffice.
    fits
        False if even the coarsest tiles exceed the budget.
    stand_ins
        Tiles that stand in for broken ones below them.
    missing
        Reasons for missing contents or children, by tile.
    """

    tiles: NDArray[np.int64]
    contents: NDArray[np.int64]
    error: float
    requested_error: float
    fits: bool
    bytes: int
    triangles: int
    stand_ins: NDArray[np.int64]
    missing: Mapping[int, str]

    def message(self) -> str:
        """Describe a selection that is coarser than requested, or incomplete; empty otherwise."""
        parts = []
        if self.error > self.requested_error:
            parts.append(
                f"tiles are shown to {self.error:.3g} pixels, not {self.requested_error:.3g}, "
                "to stay in the budget"
            )
        if not self.fits:
            parts.append("even the coarsest tiles are beyond the budget")
        if self.missing:
            first = next(iter(self.missing.values()))
            parts.append(f"{len(self.missing)} tiles are missing, the first: {first}")
        return "; ".join(parts)


@dataclass
class _Measured:
    """Screen-space errors and request volumes of the tiles read so far."""

    loader: Loader
    views: Views
    matrix: NDArray[np.float64]
    margin: float
    shadows: bool
    error: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    outside_request_volume: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, bool))

    def extend(self) -> None:
        """Measure tiles that were read since the last call."""
        tree, measured_count = self.loader.tree, len(self.error)
        if measured_count == tree.size:
            return
        new = np.arange(measured_count, tree.size)
        volumes = self.to_scene(tree.volumes.take(new))
        self.error = np.concatenate([self.error, self.visible_error(volumes, tree.error[measured_count:])])
        outside = np.zeros(len(new), bool)
        asking = [tile for tile in sorted(tree.request) if tile >= measured_count]
        if asking:
            request = self.to_scene(Volumes.concatenate([tree.request[tile] for tile in asking]))
            inside = tiles.contains_any(*_arrays(request), self.views.eyes)
            outside[np.array(asking) - measured_count] = ~inside
        self.outside_request_volume = np.concatenate([self.outside_request_volume, outside])

    def to_scene(self, volumes: Volumes) -> Volumes:
        """Transform volumes to the scene."""
        return volumes.moved(self.matrix[None], np.zeros(len(volumes.padding), np.int64))

    def visible_error(self, volumes: Volumes, error: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute the screen-space errors of volumes in the scene, pixels; -1: not visible."""
        scale = float(np.linalg.norm(self.matrix[:3, :3], ord=2))
        errors = tiles.screen_error(
            *_arrays(volumes),
            error * scale,
            self.views.view_set,
            self.views.pixels,
            margin=self.margin,
            shadows=self.shadows,
        )
        if self.views.horizon is not None:
            earth = np.linalg.inv(self.views.horizon)
            centre, eyes = (
                each @ earth[:3, :3].T + earth[:3, 3] for each in (volumes.centre, self.views.eyes)
            )
            radius = np.linalg.norm(volumes.half, axis=1) + volumes.padding
            errors[horizon.hidden_mask(centre, radius, eyes)] = -1.0
        return errors


def select_tiles(
    loader: Loader,
    views: Views,
    matrix: NDArray[np.float64],
    error: float,
    budget: Budget | None = None,
    *,
    margin: float = 0.0,
    shadows: bool = False,
    fetch: bool = True,
    on_content: Callable[[int, bytes], object] | None = None,
    triangles: Mapping[int, int] | None = None,
    progress: Progress = silent,
) -> TileSelection:
    """Select the tiles of a shot, and read the required part of the tree.

    Parameters
    ----------
    matrix
        (4, 4) from the tileset's root to the scene (`place.ecef_to_frame`).
    error
        Screen-space error to which tiles are refined, pixels.
    margin
        Width added to each view frustum, m: for light from outside of the picture, and blur.
    shadows
        A tile counts as visible if its shadow falls on a visible place.
    fetch
        Fetch the contents to check their presence and type.
    on_content
        Called with the number and bytes of each fetched content; some may not be part of the selection.
    triangles
        Known numbers of triangles, by content.

    Raises
    ------
    InputError
        A file of the tileset is invalid or refused, or the source stopped answering.
    """
    measured = _Measured(loader, views, matrix, margin, shadows)
    sizes = _Sizes(loader, triangles or {}, on_content, progress)
    limits = [
        -1 if most is None else most
        for most in ((budget.tiles, budget.bytes, budget.triangles) if budget else (None, None, None))
    ]
    while True:
        measured.extend()
        tree = loader.tree
        flags = tree.flags() | np.where(
            measured.outside_request_volume, np.uint8(tiles.OUTSIDE_REQUEST_VOLUME), np.uint8(0)
        )
        cut = tiles.select(tree.parent, flags, measured.error, *sizes.arrays(), error, *limits)
        if len(cut.expand):
            loader.expand(cut.expand)
            continue
        contents = _visible_contents(measured, cut)
        if limits[1] >= 0 and sizes.fetch_sizes(contents):
            continue
        if not fetch or not sizes.check(contents):
            return TileSelection(
                *(cut.tiles, contents, cut.error, error, cut.fits, cut.bytes, cut.triangles, cut.stand_ins),
                dict(sorted(tree.broken.items())),
            )


class _Sizes:
    """Known bytes and triangles of tiles."""

    def __init__(
        self,
        loader: Loader,
        triangles: Mapping[int, int],
        on_content: Callable[[int, bytes], object] | None,
        progress: Progress,
    ) -> None:
        self.loader, self.triangles, self.on_content, self.progress = loader, triangles, on_content, progress
        self.known: dict[int, int] = {}

    def arrays(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return bytes (n,) and triangles (n,) of all tiles; 0: unknown."""
        result = np.zeros((2, self.loader.tree.size), np.int64)
        for row, numbers in zip(result, (self.known, self.triangles), strict=True):
            if numbers:
                owner = self.loader.tree.content[list(numbers), 0]
                np.add.at(row, owner, np.array(list(numbers.values())))
        return result[0], result[1]

    def fetch_sizes(self, contents: NDArray[np.int64]) -> bool:
        """Get the bytes of contents from the source; return whether any are new."""
        source, new = self.loader.source, False
        for content in map(int, contents):
            if content not in self.known and (size := source.size(self.loader.content_uri(content))):
                self.known[content] = size
                new = True
        return new

    def check(self, contents: NDArray[np.int64]) -> bool:
        """Fetch new contents; return whether the tree or a size has changed."""

        def keep(content: int, data: bytes) -> None:
            self.known[content] = len(data)
            if self.on_content is not None:
                self.on_content(content, data)

        before = dict(self.known)
        return self.loader.check(contents, keep, self.progress) or self.known != before


def _visible_contents(measured: _Measured, cut: tiles.Cut) -> NDArray[np.int64]:
    """Return the contents of a cut, without invisible contents of added tiles."""
    tree = measured.loader.tree
    contents = tree.contents_of(cut.tiles)
    contents = contents[tree.content_kind[contents] == MODEL]
    own = [content for content in map(int, contents) if content in tree.content_volume]
    if not own:
        return contents
    parent = tree.parent[tree.content[own, 0]]
    added = (parent >= 0) & ~tree.replaces[parent]
    volumes = measured.to_scene(Volumes.concatenate([tree.content_volume[content] for content in own]))
    unseen = measured.visible_error(volumes, np.zeros(len(own))) < 0.0
    return np.setdiff1d(contents, np.array(own)[added & unseen])


_Four = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


def _arrays(volumes: Volumes) -> _Four:
    return volumes.centre, volumes.axis, volumes.half, volumes.padding
