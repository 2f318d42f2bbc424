"""Metadata that override a tile's bounding volume or error (3D Tiles 1.1: semantics of tiles)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .json_text import Node

_VOLUMES = {"TILE_BOUNDING_BOX": "box", "TILE_BOUNDING_REGION": "region", "TILE_BOUNDING_SPHERE": "sphere"}
_COUNTS = {"box": 12, "region": 6, "sphere": 4}
_HEIGHTS = ("TILE_MINIMUM_HEIGHT", "TILE_MAXIMUM_HEIGHT")
_ERROR = "TILE_GEOMETRIC_ERROR"
_COMPONENTS = {
    **{f"INT{bits}": f"<i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"UINT{bits}": f"<u{bits // 8}" for bits in (8, 16, 32, 64)},
    "FLOAT32": "<f4",
    "FLOAT64": "<f8",
}
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


@dataclass(frozen=True)
class Overrides:
    """Values of one tile from metadata."""

    volume: tuple[str, list[float]] | None = None
    low: float | None = None
    high: float | None = None
    error: float | None = None

    def with_heights(self, kind: str, numbers: list[float]) -> list[float]:
        """Replace the heights of a region, m; other volumes are unchanged."""
        if kind != "region":
            return numbers
        low = numbers[4] if self.low is None else self.low
        high = numbers[5] if self.high is None else self.high
        return [*numbers[:4], low, high]


@dataclass(frozen=True)
class Property:
    """A property of a class with a known semantic.

    Attributes
    ----------
    count
        Number of components of one value.
    """

    semantic: str
    component: str
    count: int
    normalized: bool = False
    offset: Any = None
    scale: Any = None
    default: Any = None


def schema_of(tileset: Node, load: Callable[[str], Node | None]) -> Node | None:
    """Return the schema of a tileset, of 1.1 or of the extension; `load` reads an external schema."""
    holder = tileset
    if (extensions := tileset.get("extensions")) is not None:
        holder = extensions.get("3DTILES_metadata") or tileset
    if (uri := holder.get("schemaUri")) is not None:
        return load(uri.text())
    return holder.get("schema")


def properties(schema: Node | None, name: str) -> dict[str, Property]:
    """List the properties of a class with a known semantic, by their ids."""
    if schema is None or (classes := schema.get("classes")) is None or (found := classes.get(name)) is None:
        return {}
    result: dict[str, Property] = {}
    for identity in ((members := found.get("properties")) and members.object()) or {}:
        node = members.need(identity) if members is not None else found
        semantic = node.value.get("semantic") if isinstance(node.value, dict) else None
        if semantic not in (*_VOLUMES, *_HEIGHTS, _ERROR):
            continue
        size = _SIZES.get(str(node.value.get("type", "SCALAR")))
        component = str(node.value.get("componentType", "FLOAT64"))
        count = node.value.get("count") if node.value.get("array") else 1
        wanted = _COUNTS[_VOLUMES[semantic]] if semantic in _VOLUMES else 1
        if (
            size is None
            or component not in _COMPONENTS
            or not isinstance(count, int)
            or size * count != wanted
        ):
            raise node.error(f"{semantic} must be {wanted} numbers of a known type")
        keys = ("normalized", "offset", "scale", "default")
        extra = {key: node.value[key] for key in keys if key in node.value}
        result[identity] = Property(semantic, component, wanted, **extra)
    return result


def of_tile(tile: Node, schema: Node | None) -> Overrides:
    """Read the metadata of an explicit tile."""
    node = tile.get("metadata")
    if node is None and (extensions := tile.get("extensions")) is not None:
        node = extensions.get("3DTILES_metadata")
    if node is None or schema is None or (name := node.get("class")) is None:
        return Overrides()
    values = node.get("properties")
    numbers_of: dict[str, NDArray[np.float64]] = {}
    for identity, each in properties(schema, name.text()).items():
        value = values.get(identity) if values is not None else None
        if value is not None:
            numbers = [value.number()] if each.count == 1 else value.numbers(each.count)
            numbers_of[each.semantic] = real(np.array([numbers]), each, {}, value)
    return of_row(numbers_of, 0, node)


def real(raw: NDArray[Any], definition: Property, table: dict[str, Any], node: Node) -> NDArray[np.float64]:
    """Convert values of a property (n, count): normalised integers, then scale and offset."""
    values = raw.astype(np.float64)
    if definition.normalized and raw.dtype.kind in "iu":
        values = np.maximum(values / np.iinfo(raw.dtype).max, -1.0)
    for key, join in (("scale", np.multiply), ("offset", np.add)):
        extra = table.get(key, getattr(definition, key))
        if extra is not None:
            try:
                values = join(values, np.ravel(np.array(extra, float)))
            except ValueError as error:
                raise node.error(f"{key} does not fit the property") from error
    if not np.isfinite(values).all():
        raise node.error(f"{definition.semantic} has a number that is not finite")
    return values


def of_row(values: dict[str, NDArray[np.float64]], row: int, node: Node) -> Overrides:
    """Make overrides from one row of the values of semantics."""
    volume = None
    for semantic, kind in _VOLUMES.items():
        if semantic in values:
            volume = (kind, values[semantic][row].tolist())
    low, high, error = (
        float(values[semantic][row, 0]) if semantic in values else None for semantic in (*_HEIGHTS, _ERROR)
    )
    if error is not None and error < 0.0:
        raise node.error("TILE_GEOMETRIC_ERROR must not be negative")
    return Overrides(volume, low, high, error)


def read_table(
    subtree: Node, buffers: list[memoryview], schema: Node | None, tables: Node, number: int
) -> tuple[dict[str, NDArray[np.float64]], int]:
    """Read the values of semantics in a property table, and its number of rows.

    Parameters
    ----------
    subtree
        JSON of the subtree, for messages.
    buffers
        Buffer views of the subtree.
    tables, number
        `propertyTables` of the subtree, and the number of a table.
    """
    every = list(tables.items())
    if number >= len(every):
        raise subtree.error(f"property table {number} is not there")
    table = every[number]
    count = table.need("count").index(1 << 40)
    columns = table.get("properties")
    values_of: dict[str, NDArray[np.float64]] = {}
    for identity, each in properties(schema, table.need("class").text()).items():
        node = columns.get(identity) if columns is not None else None
        if node is None:
            continue
        view = node.need("values", "bufferView").index(len(buffers) - 1)
        dtype = np.dtype(_COMPONENTS[each.component])
        need = count * each.count * dtype.itemsize
        if len(buffers[view]) < need:
            raise node.error(f"needs {need:,} bytes, its buffer view has {len(buffers[view]):,}")
        raw = np.frombuffer(buffers[view], dtype, count * each.count).reshape(count, each.count)
        values_of[each.semantic] = real(raw, each, node.object(), node)
    return values_of, count
