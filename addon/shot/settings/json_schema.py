"""The settings as a JSON Schema, by which editors complete, explain and check scene files."""

from __future__ import annotations

import typing
from datetime import datetime
from pathlib import Path
from typing import Any

from .schema import Field, Key, fields, plain, summary

_TYPES = {
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    float: {"type": "number"},
    str: {"type": "string"},
    Path: {"type": "string"},
    datetime: {"type": "string", "format": "date-time"},
}


def json_schema(kind: type) -> dict[str, Any]:
    """JSON Schema (2020-12) of the files that hold a dataclass of settings."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": summary(kind)} | _table(kind)


def _table(kind: type) -> dict[str, Any]:
    """A dataclass; where one of several kinds stands in it, a schema for each of them."""
    rig = next((part for part in fields(kind) if part.key.variants), None)
    if not rig:
        return _object([part for part in fields(kind)], {}, [])
    return {
        "oneOf": [
            _of_kind(kind, rig.key, name, rig_kind) for name, rig_kind in rig.key.all_variants().items()
        ]
    }


def _of_kind(kind: type, key: Key, name: str, rig_kind: type) -> dict[str, Any]:
    own = [part for part in fields(kind) if not part.key.variants]
    tag = {key.tag: {"const": name, "description": f"{key.help}: {summary(rig_kind)}"}}
    found = _object([*own, *fields(rig_kind)], tag, [] if name == key.default_kind else [key.tag])
    return {"title": name, "description": summary(rig_kind)} | found


def _object(known: list[Field], more: dict[str, Any], required: list[str]) -> dict[str, Any]:
    properties = more | {part.name: _property(part) for part in known}
    found = {"type": "object", "properties": properties, "additionalProperties": False}
    return found | ({"required": required} if required else {})


def _property(part: Field) -> dict[str, Any]:
    found: dict[str, Any] = {"description": part.key.described()}
    if part.table:
        table = _table(part.table)
        return found | ({"type": "array", "items": table} if part.tables else table)
    if part.default is not None:
        found["default"] = plain(part.type, part.default)
    inner = typing.get_args(part.type)
    return found | (_list(inner, part.key) if inner else _one(part.type, part.key))


def _list(inner: tuple[Any, ...], key: Key) -> dict[str, Any]:
    found: dict[str, Any] = {"type": "array", "items": _one(inner[0], key)}
    if inner[-1] is not Ellipsis:
        found |= {"minItems": len(inner), "maxItems": len(inner)}
    return found | ({"uniqueItems": True} if key.choices else {})


def _one(kind: type, key: Key) -> dict[str, Any]:
    """A value that is no list, or one in a list."""
    bounds = {"minimum": key.at_least, "exclusiveMinimum": key.above, "maximum": key.at_most}
    found = _TYPES[kind] | {name: bound for name, bound in bounds.items() if bound is not None}
    return found | ({"enum": list(key.names())} if key.choices else {})
