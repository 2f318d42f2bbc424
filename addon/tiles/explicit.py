"""Reader of a tileset.json into rows of a tree; tolerates common deviations from the specification."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import limits
from . import documents, implicit, metadata, scheme, volumes
from .json_text import Node
from .tree import EXTERNAL, Document, Rows, Tree
from .volumes import Volumes

MOST_CONTENTS = limits.TILE_CONTENTS
_SINGULAR = 1e-12  # determinant of columns of length 1


@dataclass(frozen=True)
class External:
    """An external tileset to read.

    Attributes
    ----------
    content
        Number of the content in the tree.
    """

    content: int


@dataclass
class _Pending:
    """A tile to visit: its JSON, and values inherited from its parent."""

    node: Node
    parent: int
    error: float
    raw_error: float
    replaces: bool
    matrix: int


def read(
    tree: Tree,
    node: Node,
    uri: str,
    holder: int = -1,
    load: Callable[[str], Node | None] = lambda _: None,
) -> int:
    """Append the tiles of a tileset.json to a tree.

    Parameters
    ----------
    node
        Root of the JSON text.
    uri
        URI of the file for its source.
    holder
        Tile whose content the tileset is; -1: the root tileset.
    load
        Reads a JSON file by a reference in this one; returns None if it is missing.

    Returns
    -------
    Number of its first tile.

    Raises
    ------
    InputError
        The tileset is invalid; nothing was appended.
    """
    document = documents.read(tree, node, uri, holder, load)
    return _Walk(tree, node, document, holder).run()


class _Walk:
    """Traversal of the tiles of one document with an explicit stack."""

    def __init__(self, tree: Tree, node: Node, document: Document, holder: int) -> None:
        self.tree, self.holder, self.document = tree, holder, document
        self.number = len(tree.documents)
        self.first = tree.size
        if holder < 0:
            matrix, error, replaces = 0, np.inf, True
        else:
            matrix = int(tree.matrix[holder])
            error, replaces = float(tree.error[holder]), bool(tree.replaces[holder])
        self.matrices = {matrix: (tree.matrix_of(holder) if holder >= 0 else np.eye(4), 1.0)}
        if holder >= 0:
            self.matrices[matrix] = self._scaled(self.matrices[matrix][0])
        stated = node.get("geometricError")
        self.whole = _error(stated) if stated is not None else None
        self.stack = [_Pending(node.need("root"), holder, error, -1.0, replaces, matrix)]
        self.texts: list[str] = []
        self.new_matrices: list[NDArray[np.float64]] = []
        self.parent: list[int] = []
        self.error: list[float] = []
        self.replaces: list[bool] = []
        self.matrix: list[int] = []
        self.paths: list[str] = []
        self.numbers: dict[str, tuple[list[int], list[list[float]]]] = {
            kind: ([], []) for kind in volumes.KINDS
        }
        self.contents: list[tuple[int, ...]] = []
        self.external: list[int] = []
        self.request: dict[int, Volumes] = {}
        self.content_volume: dict[int, Volumes] = {}
        self.jobs: dict[int, list[Any]] = {}
        self.placeholders: list[int] = []
        self.flat: dict[int, str] = {}

    def run(self) -> int:
        """Visit all tiles, then append them."""
        while self.stack:
            self._visit(self.stack.pop())
        tree = self.tree
        tree.add_document(self.document)
        for text in self.texts:
            tree.add_text(text)
        for matrix in self.new_matrices:
            tree.add_matrix(matrix)
        first_content = tree.contents
        first = tree.append(self._rows())
        for content in self.external:
            tree.set_kind(first_content + content, EXTERNAL)
        tree.broken |= {first + row: reason for row, reason in self.flat.items()}
        tree.flat |= {first + row for row in self.flat}
        return first

    def _rows(self) -> Rows:
        n = len(self.parent)
        matrix = np.array(self.matrix, np.int64)
        return Rows(
            np.array(self.parent, np.int64),
            np.array(self.error),
            np.array(self.replaces, bool),
            self._volumes(matrix),
            matrix,
            np.full(n, self.number),
            np.array(self.contents, np.int64).reshape(-1, 7),
            self.request,
            self.content_volume,
            self.jobs,
            self.placeholders,
            self.paths,
        )

    def _volumes(self, matrix: NDArray[np.int64]) -> Volumes:
        """Compute the bounding volumes of all rows in the root's frame."""
        used, which = np.unique(matrix, return_inverse=True)
        matrices = np.stack([self.matrices[int(each)][0] for each in used])
        order, parts = [], []
        for kind, (rows, numbers) in self.numbers.items():
            if rows:
                part = volumes.from_numbers(kind, np.array(numbers))
                parts.append(part if kind == "region" else part.moved(matrices, which[rows]))
                order += rows
        return Volumes.concatenate(parts).take(np.argsort(np.array(order, np.int64)))

    def _visit(self, tile: _Pending) -> None:
        node, row = tile.node, len(self.parent)
        self.tree.check_room(row + 1, self.document.name)
        node.object()
        matrix, flat = self._transform(node, tile.matrix)
        if flat:
            self.flat[row] = flat
        overrides = metadata.of_tile(node, self.document.schema)
        raw = self._raw_error(node, tile, overrides)
        replaces = self._refine(node, tile.replaces)
        error = raw * self.matrices[matrix][1]
        if not np.isfinite(error):
            raise node.error("geometricError times the scale of its transform is not finite")
        self.parent.append(tile.parent)
        self.error.append(error)
        self.replaces.append(replaces)
        self.matrix.append(matrix)
        self.paths.append(node.path)
        bounds = node.need("boundingVolume")
        kind, numbers = overrides.volume or volumes.read(bounds)
        numbers = overrides.with_heights(kind, numbers)
        self.numbers[kind][0].append(row)
        self.numbers[kind][1].append(numbers)
        if flat:  # its content and its children have no volume
            return
        if (request := node.get("viewerRequestVolume")) is not None:
            self.request[row] = self._transform_volume(*volumes.read(request), matrix)
        contents = _contents(node)
        tiling = scheme.read(node)
        if tiling is not None:
            place = implicit.TilePlace(kind, numbers, matrix, error, replaces, self.document, self.number)
            self.jobs[row] = [implicit.Subtree(tiling, place, contents, (0, 0, 0, 0))]
            self.placeholders.append(row)
            return
        for content in contents:
            self._content(content, row, matrix)
        if (children := node.get("children")) is not None:
            below = [
                _Pending(each, self.first + row, error, raw, replaces, matrix) for each in children.items()
            ]
            self.stack += reversed(below)

    def _transform(self, node: Node, above: int) -> tuple[int, str]:
        """Multiply a tile's transform with its parent's; return the number of the product.

        The text is the reason if the transform flattens the tile, which the specification allows: it has no
        volume then, so its parent is shown in its place, and the number is the parent's.
        """
        transform = node.get("transform")
        if transform is None:
            return above, ""
        local = np.array(transform.numbers(16)).reshape(4, 4).T
        if np.abs(local[3] - [0.0, 0.0, 0.0, 1.0]).max() > 1e-9:
            raise transform.error("is not affine: every fourth number must be 0, the last one 1")
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = self.matrices[above][0] @ local
            lengths = np.linalg.norm(local[:3, :3], axis=0)
            unit = local[:3, :3] / np.where(lengths > 0.0, lengths, 1.0)
            singular = not abs(np.linalg.det(unit)) > _SINGULAR if np.isfinite(unit).all() else True
        if not (np.isfinite(matrix).all() and np.isfinite(lengths).all()):
            raise transform.error("is not finite with its parents'")
        if singular:
            return above, str(transform.error("flattens the tile (determinant 0), which is not shown"))
        number = self.tree.matrix_count + len(self.new_matrices)
        self.new_matrices.append(matrix)
        self.matrices[number] = self._scaled(matrix)
        return number, ""

    @staticmethod
    def _scaled(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
        return matrix, float(volumes.largest_scale(matrix[None, :3, :3])[0])

    def _raw_error(self, node: Node, tile: _Pending, overrides: metadata.Overrides) -> float:
        """Return the geometric error in the tile's frame; half the parent's error if it is missing."""
        if overrides.error is not None:
            return overrides.error
        stated = node.get("geometricError")
        if stated is not None:
            return _error(stated)
        if tile.raw_error >= 0.0:
            return 0.5 * tile.raw_error
        if self.whole is None:
            raise node.error("geometricError is missing, and the tileset has none either")
        return self.whole

    @staticmethod
    def _refine(node: Node, above: bool) -> bool:
        refine = node.get("refine")
        if refine is None:
            return above
        if (word := refine.text().upper()) not in ("ADD", "REPLACE"):
            raise refine.error(f"must be ADD or REPLACE, not {word[:40]!r}")
        return word == "REPLACE"

    def _transform_volume(self, kind: str, numbers: list[float], matrix: int) -> Volumes:
        found = volumes.from_numbers(kind, np.array([numbers]))
        if kind == "region":
            return found
        return found.moved(self.matrices[matrix][0][None], np.zeros(1, np.int64))

    def _content(self, content: Node, row: int, matrix: int) -> None:
        uri = content.need("uri", "url").text()
        if not uri.strip():
            return
        number = len(self.contents)
        if (bounds := content.get("boundingVolume")) is not None:
            self.content_volume[number] = self._transform_volume(*volumes.read(bounds), matrix)
        self.contents.append((row, self.number, len(self.tree.texts) + len(self.texts), -1, 0, 0, 0))
        self.texts.append(uri)
        if _path_of(uri).endswith(".json"):
            self.external.append(number)
            self.jobs.setdefault(row, []).append(External(self.tree.contents + number))


def _error(node: Node) -> float:
    value = node.number()
    if value < 0.0:
        raise node.error("must not be negative")
    return value


def _contents(node: Node) -> list[Node]:
    """List the contents of a tile; in 1.0 an extension allows several."""
    one = node.get("content")
    if one is not None and "extensions" not in node and "contents" not in node:
        return [one]
    holder = node
    if (extensions := node.get("extensions")) is not None:
        holder = extensions.get("3DTILES_multiple_contents") or node
    if (
        several := holder.get("contents", "content") if holder is not node else node.get("contents")
    ) is not None:
        found = list(several.items())
        if len(found) > MOST_CONTENTS:
            raise several.error(f"has more than {MOST_CONTENTS} contents")
        return found
    return [one] if one is not None else []


def _path_of(uri: str) -> str:
    return uri.partition("#")[0].partition("?")[0].lower()
