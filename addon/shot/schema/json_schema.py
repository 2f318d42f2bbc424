"""JSON Schema of the settings, for completion, help and validation of scene files in editors."""

from __future__ import annotations

import typing
from datetime import datetime
from pathlib import Path
from typing import Any

from . import Field, Key, fields, plain, summary
from .frame_list import FrameList

_TYPES = {
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    float: {"type": "number"},
    str: {"type": "string"},
    FrameList: {"type": "string"},
    Path: {"type": "string"},
    datetime: {"type": "string", "format": "date-time"},
}


def json_schema(kind: type) -> dict[str, Any]:
    """JSON Schema (2020-12) of files that hold a dataclass of settings."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": summary(kind)} | _table(kind)


def _table(kind: type) -> dict[str, Any]:
    """Make the schema of a dataclass; a table with variants has one for each of them."""
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
    schema = _object([*own, *fields(rig_kind)], tag, [] if name == key.default_kind else [key.tag])
    return {"title": name, "description": summary(rig_kind)} | schema


def _object(known: list[Field], more: dict[str, Any], required: list[str]) -> dict[str, Any]:
    properties = more | {part.name: _property(part) for part in known}
    schema = {"type": "object", "properties": properties, "additionalProperties": False}
    return schema | ({"required": required} if required else {})


def _property(part: Field) -> dict[str, Any]:
    schema: dict[str, Any] = {"description": part.key.described()}
    if part.table:
        table = _table(part.table)
        return schema | ({"type": "array", "items": table} if part.tables else table)
    if part.default is not None:
        schema["default"] = plain(part.type, part.default)
    inner = typing.get_args(part.type)
    return schema | (_list(inner, part.key) if inner else _one(part.type, part.key))


def _list(inner: tuple[Any, ...], key: Key) -> dict[str, Any]:
    schema: dict[str, Any] = {"type": "array", "items": _one(inner[0], key)}
    if inner[-1] is not Ellipsis:
        schema |= {"minItems": len(inner), "maxItems": len(inner)}
    return schema | ({"uniqueItems": True} if key.choices else {})


def _one(kind: type, key: Key) -> dict[str, Any]:
    """Make the schema of a single value, or of an item of a list."""
    bounds = {"minimum": key.at_least, "exclusiveMinimum": key.above, "maximum": key.at_most}
    schema = _TYPES[kind] | {name: bound for name, bound in bounds.items() if bound is not None}
    return schema | ({"enum": list(key.names())} if key.choices else {})
