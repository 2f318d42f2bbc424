"""Blender properties generated from the settings' schema, with its names, units, bounds and help.

Blender stores numbers in single precision and lists of choices without order, and has no unset properties.
`put` and `take` convert values in both directions. A value that does not survive the conversion is stored in
the group's `exact` text, and is used while the property still shows the converted value.
"""

from __future__ import annotations

import json
import typing
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..blender import stored_json
from ..errors import Error
from ..shot.schema import Field, Key, fields, plain
from ..shot.schema.frame_list import FrameList

Items = tuple[tuple[str, str, str], ...]

USE = "use_"
"""Prefix of the property that enables an optional number."""

_SHORT = {"cpu", "edl", "eevee", "fps", "gpu", "lwir", "mwir", "rgb", "vr"}  # names in capitals
_SPELLED = {
    "acescg": "ACEScg",
    "exr_space": "EXR space",
    "h264": "H.264",
    "h265": "H.265",
    "prores": "ProRes",
    "rec709": "Rec.709",
}
_LARGEST = 2**31 - 1  # stored by Blender as an integer
_NUMBERS = (int, float)
_UNITS = {"m": "LENGTH", "s": "TIME_ABSOLUTE"}  # units that Blender displays
_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"}


def create_property(kind: type, name: str, first: tuple[str, str, str] | None = None, **options: Any) -> Any:
    """Create the Blender property of the key `name` of a settings dataclass.

    Parameters
    ----------
    first
        An additional choice (identifier, name, description) before the schema's, which becomes the default.
    options
        Arguments for `bpy.props` that override the schema.
    """
    part = next(part for part in fields(kind) if part.name == name)
    about = {"name": label(name), "description": sentence(part.key.described())}
    if part.key.choices is not None:
        return bpy.props.EnumProperty(**{**about, **_choice_options(part, first), **options})
    make, more = _plain_property(part)
    return make(**{**about, **more, **options})


def create_switch(part: Field, **options: Any) -> Any:
    """Create the Blender property that enables an optional number; `options` as in `create_property`."""
    text = f"Set this value: {part.key.described()}"
    return bpy.props.BoolProperty(name=label(part.name), description=text, default=False, **options)


def has_switch(part: Field) -> bool:
    """Return whether a number is optional and needs a switch; empty text needs none."""
    return part.default is None and (part.type in _NUMBERS or typing.get_origin(part.type) is tuple)


def items(key: Key) -> Items:
    """Return the choices of a key as enumeration items."""
    return tuple((name, label(name), sentence(words)) for name, words in key.names().items())


def label(name: str) -> str:
    """Turn a key into a label: ``thermal_low`` -> ``Thermal low``, ``rgb`` -> ``RGB``."""
    if name in _SPELLED:
        return _SPELLED[name]
    return name.upper() if name in _SHORT else sentence(name.replace("_", " "))


def section_title(section: str) -> str:
    """Return the title of the panel of a section of a scene file."""
    return {"thermal": "Sensors"}.get(section, label(section))


def heading(part: Field) -> str:
    """Return the panel label of a key, with its unit if Blender does not display it after the number."""
    unit = "UTC" if part.type is datetime else part.key.unit
    return f"{label(part.name)} ({unit})" if unit and unit not in _UNITS else label(part.name)


def sentence(text: str) -> str:
    """Capitalize the first letter and drop the final period, as in Blender tooltips."""
    return text[:1].upper() + text[1:]


def put(group: bpy.types.PropertyGroup, part: Field, value: Any) -> None:
    """Set a group's property to a value of the key."""
    exact = stored_json.table(group.exact)
    exact.pop(part.name, None)
    _show(group, part, value)
    if take(group, part, {}) != value:
        exact[part.name] = _serialize(value)
    group.exact = json.dumps(exact) if exact else ""


def take(group: bpy.types.PropertyGroup, part: Field, exact: dict[str, Any] | None = None) -> Any:
    """Return the value of the key that a group's property shows.

    Raises
    ------
    Error
        A typed text is not a valid value.
    """
    exact = stored_json.table(group.exact) if exact is None else exact
    kept = _restore(part, exact[part.name]) if part.name in exact else _ABSENT
    same = kept is not _ABSENT and stored_value(group, part) == _stored_as(part, kept)
    return kept if same else _value(group, part)


def is_showing(group: bpy.types.PropertyGroup, part: Field, value: Any) -> bool:
    """Return whether a property shows this value."""
    return stored_value(group, part) == _stored_as(part, value)


def is_changed(group: bpy.types.PropertyGroup, part: Field) -> bool:
    """Return whether a property differs from its default."""
    return not is_showing(group, part, part.default)


_ABSENT = object()


def _serialize(value: Any) -> Any:
    """Serialize a value to JSON, without loss."""
    if isinstance(value, datetime):
        return value.isoformat()
    return list(value) if isinstance(value, tuple) else str(value) if isinstance(value, Path) else value


def _restore(part: Field, stored: Any) -> Any:
    """Restore a value from `_serialize` JSON, if it is valid for the key."""
    try:
        if part.type is datetime:
            return datetime.fromisoformat(stored)
        if part.type is Path:
            return Path(stored)
        return tuple(stored) if isinstance(stored, list) else stored
    except (TypeError, ValueError):
        return _ABSENT


def _show(group: bpy.types.PropertyGroup, part: Field, value: Any) -> None:
    use, shown = _stored_as(part, value)
    if has_switch(part):
        setattr(group, USE + part.name, use)
    if use:
        setattr(group, part.name, shown)


def stored_value(group: bpy.types.PropertyGroup, part: Field) -> tuple[bool, Any]:
    """Return the panel's value: whether it is enabled, and the value as stored by Blender."""
    if has_switch(part) and not getattr(group, USE + part.name):
        return False, None
    value = getattr(group, part.name)
    return True, tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value


def _stored_as(part: Field, value: Any) -> tuple[bool, Any]:
    """Return the result of `stored_value` for a property set to `value`."""
    if value is None:
        return (False, None) if has_switch(part) else (True, "")
    if isinstance(value, datetime):
        utc = value.astimezone(UTC).replace(tzinfo=None)
        return True, utc.isoformat(sep=" ", timespec="minutes")
    if isinstance(value, Path):
        return True, str(value)
    if isinstance(value, tuple):
        if part.key.choices is not None:
            return True, set(value)
        if typing.get_args(part.type)[-1] is Ellipsis:
            return True, json.dumps(plain(part.type, value))[1:-1]
        return True, tuple(_stored_number(part, each) for each in value)
    if type(value) in _NUMBERS:
        return True, _stored_number(part, value)
    return True, value


def _stored_number(part: Field, value: float) -> float:
    """Return a number as stored by Blender: clamped, in single precision."""
    low, high = _bounds(part)
    if isinstance(value, int):
        return min(max(value, low if low is not None else -_LARGEST - 1), min(high or _LARGEST, _LARGEST))
    limit = float(np.finfo(np.float32).max)
    least = float(np.float32(-limit if low is None else low))
    return float(np.float32(min(max(value, least), limit if high is None else high)))


def _value(group: bpy.types.PropertyGroup, part: Field) -> Any:
    """Return the key's value from its property: numbers as the shortest equal decimal (float32)."""
    use, value = stored_value(group, part)
    if not use:
        return None
    inner = typing.get_args(part.type)
    if inner and part.key.choices is not None:
        return tuple(name for name in part.key.names() if name in value)
    if inner and inner[-1] is Ellipsis:
        return _parse_list(part, value)
    if inner:
        return tuple(_shortest(each) for each in value)
    if part.type in (Path, datetime):
        if not value.strip():
            return None
        return Path(bpy.path.abspath(value)) if part.type is Path else _parse_time(part, value)
    return _shortest(value)


def _shortest(value: Any) -> Any:
    return float(str(np.float32(value))) if isinstance(value, float) else value


def _parse_list(part: Field, text: str) -> tuple[Any, ...]:
    """Parse a typed list such as ``1, 2.5``, or of texts with or without quotation marks."""
    kind = typing.get_args(part.type)[0]
    try:
        listed = json.loads(f"[{text}]")
    except (ValueError, RecursionError):
        if kind is not str:
            raise Error(f'{label(part.name)}: "{text}" is not a list; separate numbers with commas') from None
        listed = [each for word in text.split(",") if (each := word.strip().strip('"').strip())]
    if not all(type(each) in ((int, float) if kind is float else (kind,)) for each in listed):
        raise Error(f'{label(part.name)}: "{text}" is not a valid list: {part.key.described()}')
    return tuple(kind(each) for each in listed)


def _parse_time(part: Field, text: str) -> datetime:
    """Parse a typed time; UTC without a zone."""
    try:
        moment = datetime.fromisoformat(text.strip())
    except ValueError:
        reason = f'"{text}" is not a date and time; write it as 2014-09-17 21:30'
        raise Error(f"{label(part.name)}: {reason}") from None
    return moment.astimezone(UTC) if moment.tzinfo else moment.replace(tzinfo=UTC)


def _choice_options(part: Field, first: tuple[str, str, str] | None) -> dict[str, Any]:
    known = items(part.key)
    if typing.get_origin(part.type) is tuple:
        return {"items": known, "options": {"ENUM_FLAG"}, "default": set(part.default)}
    return {"items": (first, *known) if first else known, "default": first[0] if first else part.default}


def _bounds(part: Field) -> tuple[float | None, float | None]:
    """Return the bounds of the number property; an exclusive bound of 0 becomes a small positive number."""
    key = part.key
    above = None if key.above is None else key.above + (1 if part.type is int else 1.0e-4)
    return key.at_least if key.at_least is not None else above, key.at_most


def _plain_property(part: Field) -> tuple[Any, dict[str, Any]]:
    """Return property type and arguments of a key without choices."""
    kind, inner = part.type, typing.get_args(part.type)
    default = None if part.default is None else _stored_as(part, part.default)[1]
    if kind is bool:
        return bpy.props.BoolProperty, {"default": default}
    if kind is Path:
        subtype = "FILE_PATH" if part.default is None else "DIR_PATH"
        return bpy.props.StringProperty, {"default": default or "", "subtype": subtype, "options": _RELATIVE}
    if kind in (str, FrameList, datetime) or (inner and inner[-1] is Ellipsis):
        return bpy.props.StringProperty, {"default": default or ""}
    low, high = _bounds(part)
    options = {name: at for name, at in (("min", low), ("max", high), ("default", default)) if at is not None}
    if kind is float:
        options |= {"precision": 3, "unit": _UNITS.get(part.key.unit, "NONE")}
    if inner:
        make = {int: bpy.props.IntVectorProperty, float: bpy.props.FloatVectorProperty}[inner[0]]
        return make, options | {"size": len(inner)}
    return {int: bpy.props.IntProperty, float: bpy.props.FloatProperty}[kind], options
