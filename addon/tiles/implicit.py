"""Reader of implicit tilings (3D Tiles 1.1, and 3DTILES_implicit_tiling of 1.0) into rows of a tree."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import metadata, subtree, volumes
from .json_text import Node
from .scheme import MOST_SUBTREE_LEVELS, Scheme
from .subtree import Availability
from .tree import Document, Rows, Tree, fill_template
from .volumes import Volumes


@dataclass(frozen=True)
class TilePlace:
    """The tile that an implicit tiling divides.

    Attributes
    ----------
    numbers
        Numbers of its box or region.
    matrix
        Number of its matrix in the tree.
    error
        Geometric error of the tiling's root, m.
    """

    kind: str
    numbers: list[float]
    matrix: int
    error: float
    replaces: bool
    document: Document
    number: int


@dataclass(frozen=True)
class Subtree:
    """A subtree to read, at (level, x, y, z)."""

    scheme: Scheme
    place: TilePlace
    contents: list[Node]
    at: tuple[int, int, int, int]

    @property
    def reference(self) -> str:
        """URI as written in its document."""
        return fill_template(self.scheme.subtrees, *self.at)


def expand(
    tree: Tree, job: Subtree, parent: int, data: bytes, name: str, load: Callable[[str], bytes]
) -> None:
    """Append the tiles of a subtree, as children of `parent`.

    Parameters
    ----------
    data, name
        Bytes and name of the subtree's file.
    load
        Reads another file by a reference in the subtree.

    Raises
    ------
    InputError
        The subtree is invalid; nothing was appended.
    """
    scheme = job.scheme
    found = subtree.read(data, name, scheme.branches, scheme.levels, len(job.contents), load)
    levels = min(scheme.levels, scheme.available - job.at[0])
    cells = _available(tree, found, job, levels, name)
    if len(cells.index):
        _append(tree, job, parent, found, cells, levels)


@dataclass(frozen=True)
class _Cells:
    """Available tiles of a subtree in level order.

    Attributes
    ----------
    index
        (n,) in the availability.
    level
        (n,) within the subtree.
    morton
        (n,) within the level.
    parent
        (n,) row of the parent, -1 for the subtree's root.
    """

    index: NDArray[np.int64]
    level: NDArray[np.int64]
    morton: NDArray[np.int64]
    parent: NDArray[np.int64]


def _available(tree: Tree, availability: Availability, job: Subtree, levels: int, name: str) -> _Cells:
    """List the tiles that are available and have available parents."""
    branches = job.scheme.branches
    parts: list[tuple[NDArray[np.int64], ...]] = []
    morton, above, start, rows = np.zeros(1, np.int64), np.full(1, -1, np.int64), 0, 0
    for level in range(levels):
        here = availability.tiles.at(start + morton)
        morton, above = morton[here], above[here]
        tree.check_room(rows + len(morton), name)
        parts.append((start + morton, np.full(len(morton), level), morton, above))
        above = np.repeat(np.arange(rows, rows + len(morton)), branches)
        rows += len(morton)
        morton = (morton[:, None] * branches + np.arange(branches)).ravel()
        start += branches**level
    return _Cells(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _append(
    tree: Tree, job: Subtree, parent: int, availability: Availability, cells: _Cells, levels: int
) -> None:
    place, n = job.place, len(cells.index)
    at = _coordinates(job, cells)
    overrides = _overrides(availability, cells, place)
    error = (
        np.array(
            [
                place.error * 0.5 ** int(level) if each.error is None else each.error * _scale(tree, place)
                for level, each in zip(at[:, 0], overrides, strict=True)
            ]
        )
        if overrides
        else place.error * 0.5 ** at[:, 0]
    )
    first = tree.size
    rows = Rows(
        np.where(cells.parent < 0, parent, first + cells.parent),
        error,
        np.full(n, place.replaces),
        _volumes(tree, job.scheme, place, at, overrides),
        np.full(n, place.matrix),
        np.full(n, place.number),
        _contents(tree, job, availability, cells, at),
        jobs=_below(job, availability, cells, at, levels),
    )
    tree.append(rows)


def _scale(tree: Tree, place: TilePlace) -> float:
    return float(volumes.largest_scale(tree.matrix_number(place.matrix)[None, :3, :3])[0])


def _coordinates(job: Subtree, cells: _Cells) -> NDArray[np.int64]:
    """Compute level, x, y, z (n, 4) of tiles in the tiling."""
    dimensions = 2 if job.scheme.branches == 4 else 3
    at = np.zeros((len(cells.index), 4), np.int64)
    at[:, 0] = job.at[0] + cells.level
    for axis in range(dimensions):
        local = np.zeros_like(cells.morton)
        for bit in range(MOST_SUBTREE_LEVELS + 1):
            local |= (cells.morton >> (bit * dimensions + axis) & 1) << bit
        at[:, 1 + axis] = (job.at[1 + axis] << cells.level) + local
    return at


def _overrides(availability: Availability, cells: _Cells, place: TilePlace) -> list[metadata.Overrides]:
    """Read the metadata of each tile; empty without metadata."""
    node, tables = availability.node, availability.node.get("propertyTables")
    holder = node
    if (extensions := node.get("extensions")) is not None and "3DTILES_metadata" in extensions:
        holder = extensions.need("3DTILES_metadata")
        tables = tables or holder.get("propertyTables")
    which = holder.get("tileMetadata")
    if tables is None or which is None:
        return []
    values, count = metadata.read_table(
        node, availability.views, place.document.schema, tables, which.index(1 << 20)
    )
    if not values:
        return []
    ranks = availability.tiles.ranks(cells.index)
    if ranks.max() >= count:
        raise which.error(f"its table has {count:,} rows, fewer than available tiles")
    return [metadata.of_row(values, int(rank), which) for rank in ranks]


def _volumes(
    tree: Tree, scheme: Scheme, place: TilePlace, at: NDArray[np.int64], overrides: list[metadata.Overrides]
) -> Volumes:
    """Compute volumes (n,) directly from the root's: repeated halving would accumulate error."""
    numbers = divide(place.kind, np.array(place.numbers), at, scheme.branches)
    own: dict[str, list[int]] = {kind: [] for kind in volumes.KINDS}
    every: dict[str, list[list[float]]] = {kind: [] for kind in volumes.KINDS}
    if not overrides:
        return _moved(tree, place, place.kind, numbers)
    for row, each in enumerate(overrides):
        kind, mine = each.volume or (place.kind, numbers[row].tolist())
        own[kind].append(row)
        every[kind].append(each.with_heights(kind, mine))
    parts = [_moved(tree, place, kind, np.array(every[kind])) for kind in own if own[kind]]
    order = np.concatenate([own[kind] for kind in own if own[kind]])
    return Volumes.concatenate(parts).take(np.argsort(order))


def _moved(tree: Tree, place: TilePlace, kind: str, numbers: NDArray[np.float64]) -> Volumes:
    found = volumes.from_numbers(kind, numbers)
    if kind == "region":
        return found
    return found.moved(tree.matrix_number(place.matrix)[None], np.zeros(len(numbers), np.int64))


def divide(
    kind: str, numbers: NDArray[np.float64], at: NDArray[np.int64], branches: int
) -> NDArray[np.float64]:
    """Divide a box or region; returns numbers (n, 12) or (n, 6) of tiles (n, 4): level, x, y, z."""
    parts = 2.0 ** at[:, 0]
    dimensions = 2 if branches == 4 else 3
    result = np.tile(numbers, (len(at), 1))
    for axis in range(dimensions):
        index = at[:, 1 + axis]
        if kind == "box":
            edge = numbers[3 + 3 * axis : 6 + 3 * axis]
            result[:, :3] += ((2 * index + 1) / parts - 1.0)[:, None] * edge
            result[:, 3 + 3 * axis : 6 + 3 * axis] = edge / parts[:, None]
        else:
            low, high = ((0, 2), (1, 3), (4, 5))[axis]
            size = numbers[high] - numbers[low]
            if axis == 0 and size < 0.0:
                size += 2.0 * np.pi
            result[:, low] = numbers[low] + size * (index / parts)
            result[:, high] = numbers[low] + size * ((index + 1) / parts)
    return result


def _contents(
    tree: Tree, job: Subtree, found: Availability, cells: _Cells, at: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Compute the contents (k, 7) of `Rows`, ordered by tile."""
    parts = [np.empty((0, 7), np.int64)]
    for node, bits in zip(job.contents, found.contents, strict=True):
        rows = np.flatnonzero(bits.at(cells.index))
        if len(rows):
            text = tree.add_text(node.need("uri", "url").text())
            fixed = np.tile([job.place.number, text], (len(rows), 1))
            parts.append(np.column_stack([rows, fixed, at[rows]]))
    joined = np.concatenate(parts)
    return joined[np.argsort(joined[:, 0], kind="stable")]


def _below(
    job: Subtree, availability: Availability, cells: _Cells, at: NDArray[np.int64], levels: int
) -> dict[int, list[Subtree]]:
    """List child subtrees, by tile of the last level."""
    scheme = job.scheme
    if levels < scheme.levels or job.at[0] + scheme.levels >= scheme.available:
        return {}
    last = np.flatnonzero(cells.level == levels - 1)
    child = cells.morton[last, None] * scheme.branches + np.arange(scheme.branches)
    there = availability.children.at(child.ravel()).reshape(child.shape)
    jobs: dict[int, list[Subtree]] = {}
    for row, mask in zip(last, there, strict=True):
        level, x, y, z = map(int, at[row])
        for bits in np.flatnonzero(mask):
            b = int(bits)
            place = (level + 1, 2 * x + (b & 1), 2 * y + (b >> 1 & 1), 2 * z + (b >> 2 & 1))
            jobs.setdefault(int(row), []).append(Subtree(scheme, job.place, job.contents, place))
    return jobs
