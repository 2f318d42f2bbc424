"""Tree of a tileset as flat arrays, read on demand."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from firetwin_core import tiles
from numpy.typing import NDArray

from .. import limits
from ..errors import InputError, input_error
from .volumes import Volumes

MOST_TILES = limits.TILE_COUNT
MODEL, EXTERNAL = 0, 1
"""Kinds of content: a model, or an external tileset."""


@dataclass(frozen=True)
class Document:
    """A tileset.json that has been read.

    Attributes
    ----------
    uri
        URI for its source.
    name
        Name for messages.
    chain
        URIs of the documents from the root to this one.
    up_axis
        Axis of its glTF files that points up: `asset.gltfUpAxis`, by default "Y".
    copyright
        `asset.copyright`, or empty.
    """

    uri: str
    name: str
    chain: tuple[str, ...]
    up_axis: str = "Y"
    copyright: str = ""
    schema: Any = None


@dataclass
class Rows:
    """Tiles to append, with their contents.

    Attributes
    ----------
    parent
        (n,) numbers in the tree, -1 for its root.
    error
        (n,) geometric errors, m of the root's frame.
    replaces
        (n,) whether children replace the tile.
    volumes
        Bounding volumes in the root's frame.
    matrix
        (n,) numbers in `Tree.matrices`.
    document
        (n,) numbers in `Tree.documents`.
    contents
        (k, 7): row of the tile, document, number in `Tree.texts`, and level, x, y, z to fill into this
        template; level -1: the text is the URI.
    request
        Viewer request volumes by row.
    content_volume
        Bounding volumes of contents, by their number in these rows.
    jobs
        Files to read for the children, by row.
    placeholders
        Rows that are the root of an implicit tiling.
    paths
        JSON paths of the rows; empty for implicit tiles.
    """

    parent: NDArray[np.int64]
    error: NDArray[np.float64]
    replaces: NDArray[np.bool_]
    volumes: Volumes
    matrix: NDArray[np.int64]
    document: NDArray[np.int64]
    contents: NDArray[np.int64]
    request: dict[int, Volumes] = field(default_factory=dict)
    content_volume: dict[int, Volumes] = field(default_factory=dict)
    jobs: dict[int, list[Any]] = field(default_factory=dict)
    placeholders: list[int] = field(default_factory=list)
    paths: list[str] = field(default_factory=list)


class Tree:
    """Tiles that have been read, parents before children.

    Attributes
    ----------
    matrices
        (m, 4, 4) products of transforms, each from a tile's content to the root's frame.
    jobs
        Files to read for the children, by tile.
    broken
        Reasons for missing contents or children, by tile.
    placeholders
        Tiles that are the root of an implicit tiling.
    flat
        Tiles that their transform flattens; they are broken.
    """

    def __init__(self) -> None:
        self.documents: list[Document] = []
        self.texts: list[str] = []
        self.jobs: dict[int, list[Any]] = {}
        self.broken: dict[int, str] = {}
        self.request: dict[int, Volumes] = {}
        self.content_volume: dict[int, Volumes] = {}
        self.placeholders: set[int] = set()
        self.flat: set[int] = set()
        self._matrices: list[NDArray[np.float64]] = [np.eye(4)]
        self._rows: list[Rows] = []
        self._kinds: list[NDArray[np.uint8]] = []
        self._columns: dict[str, NDArray] = {}
        self._volumes: Volumes | None = None
        self.size, self.contents = 0, 0

    def add_document(self, document: Document) -> int:
        """Append a document; return its number."""
        self.documents.append(document)
        return len(self.documents) - 1

    def add_text(self, text: str) -> int:
        """Append a URI or a template of URIs; return its number."""
        self.texts.append(text)
        return len(self.texts) - 1

    def add_matrix(self, matrix: NDArray[np.float64]) -> int:
        """Append a matrix (4, 4); return its number."""
        self._matrices.append(matrix)
        return len(self._matrices) - 1

    def check_room(self, more: int, name: str) -> None:
        """Check that this many tiles can be added.

        Raises
        ------
        InputError
            The tree would exceed `MOST_TILES`.
        """
        if self.size + more > MOST_TILES:
            raise input_error(name, f"makes more than {MOST_TILES:,} tiles; take a part of the tileset")

    def append(self, rows: Rows) -> int:
        """Append tiles; return the number of the first one."""
        first = self.size
        self._rows.append(rows)
        self._kinds.append(np.zeros(len(rows.contents), np.uint8))
        self.jobs |= {first + row: jobs for row, jobs in rows.jobs.items()}
        self.request |= {first + row: volume for row, volume in rows.request.items()}
        self.content_volume |= {self.contents + k: volume for k, volume in rows.content_volume.items()}
        self.placeholders |= {first + row for row in rows.placeholders}
        self.size += len(rows.parent)
        self.contents += len(rows.contents)
        self._columns.clear()
        self._volumes = None
        return first

    @property
    def matrices(self) -> NDArray[np.float64]:
        """(m, 4, 4)."""
        return np.stack(self._matrices)

    @property
    def matrix_count(self) -> int:
        """Number of matrices."""
        return len(self._matrices)

    def matrix_number(self, number: int) -> NDArray[np.float64]:
        """Return a matrix (4, 4) by its number."""
        return self._matrices[number]

    def matrix_of(self, tile: int) -> NDArray[np.float64]:
        """Return the matrix (4, 4) from the tile's frame to the root's."""
        return self._matrices[int(self.matrix[tile])]

    @property
    def parent(self) -> NDArray[np.int64]:
        """(n,) -1 for the root."""
        return self._column("parent")

    @property
    def error(self) -> NDArray[np.float64]:
        """(n,) geometric errors times the largest scale of the transforms, m."""
        return self._column("error")

    @property
    def replaces(self) -> NDArray[np.bool_]:
        """(n,) whether children replace the tile."""
        return self._column("replaces")

    @property
    def matrix(self) -> NDArray[np.int64]:
        """(n,) of `matrices`."""
        return self._column("matrix")

    @property
    def document(self) -> NDArray[np.int64]:
        """(n,) of `documents`."""
        return self._column("document")

    @property
    def volumes(self) -> Volumes:
        """Bounding volumes in the root's frame."""
        if self._volumes is None:
            self._volumes = Volumes.concatenate([rows.volumes for rows in self._rows])
        return self._volumes

    @property
    def level(self) -> NDArray[np.int64]:
        """(n,) number of ancestors."""
        if "level" not in self._columns:
            level = np.zeros(self.size, np.int64)
            left, up = np.flatnonzero(self.parent >= 0), self.parent.copy()
            while len(left):
                level[left] += 1
                up[left] = self.parent[up[left]]
                left = left[up[left] >= 0]
            self._columns["level"] = level
        return self._columns["level"]

    @property
    def content(self) -> NDArray[np.int64]:
        """(k, 7) contents: tile, document, text, and level, x, y, z (see `Rows`)."""
        if "content" not in self._columns:
            parts, first = [np.empty((0, 7), np.int64)], 0
            for rows in self._rows:
                parts.append(rows.contents + np.array([first, 0, 0, 0, 0, 0, 0]))
                first += len(rows.parent)
            self._columns["content"] = np.concatenate(parts)
        return self._columns["content"]

    @property
    def content_kind(self) -> NDArray[np.uint8]:
        """(k,) MODEL or EXTERNAL, as known so far."""
        if len(self._kinds) > 1:
            self._kinds = [np.concatenate(self._kinds)]
        return self._kinds[0] if self._kinds else np.empty(0, np.uint8)

    def set_kind(self, content: int, kind: int) -> None:
        """Set the kind of a content."""
        self.content_kind[content] = kind

    def reference(self, content: int) -> str:
        """Return the URI of a content as written in its document."""
        _, _, text, level, x, y, z = map(int, self.content[content])
        return self.texts[text] if level < 0 else fill_template(self.texts[text], level, x, y, z)

    def contents_of(self, some: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the numbers of the contents of these tiles, ascending."""
        return np.flatnonzero(np.isin(self.content[:, 0], some))

    def flags(self) -> NDArray[np.uint8]:
        """Compute flags (n,) for `firetwin_core.tiles.select`; the caller adds OUTSIDE_REQUEST_VOLUME."""
        owner, kind = self.content[:, 0], self.content_kind
        model, external = np.zeros((2, self.size), bool)
        model[owner[kind == MODEL]] = True
        external[owner[kind == EXTERNAL]] = True
        pending, broken = np.zeros((2, self.size), bool)
        pending[list(self.jobs)] = True
        broken[list(self.broken)] = True
        model |= broken & external
        inner = np.zeros(self.size, bool)
        inner[self.parent[self.parent >= 0]] = True
        inner |= pending
        above = np.where(self.parent >= 0, self.error[self.parent], np.inf)
        empty = ~model & ~external & inner & (self.error >= above)
        stand_in = np.zeros(self.size, bool)
        stand_in[list(self.placeholders)] = True
        model |= broken & stand_in
        model[list(self.flat)] = True  # a missing content
        holder = external | stand_in
        return (
            tiles.REPLACES * self.replaces
            + tiles.UNCONDITIONAL * (holder | empty)
            + tiles.CONTENT * model
            + tiles.PENDING * pending
            + tiles.BROKEN * broken
            + tiles.PASS_THROUGH * holder
        ).astype(np.uint8)

    def error_at(self, tile: int, reason: str) -> InputError:
        """Make an InputError with the file and JSON path of a tile."""
        document = self.documents[int(self.document[tile])]
        return input_error(document.name, f"{self.path(tile)}: {reason}")

    def path(self, tile: int) -> str:
        """Return the JSON path of a tile in its document; its number for a tile of an implicit tiling."""
        for rows in self._rows:
            if tile < len(rows.parent):
                return rows.paths[tile] if rows.paths else f"implicit tile {tile}"
            tile -= len(rows.parent)
        raise IndexError(tile)

    def _column(self, name: str) -> NDArray:
        if name not in self._columns:
            parts = [getattr(rows, name) for rows in self._rows]
            self._columns[name] = np.concatenate(parts) if parts else np.empty(0, np.int64)
        return self._columns[name]


def fill_template(template: str, level: int, x: int, y: int, z: int) -> str:
    """Fill in the variables of a template of URIs."""
    for name, value in (("{level}", level), ("{x}", x), ("{y}", y), ("{z}", z)):
        template = template.replace(name, str(value))
    return template
