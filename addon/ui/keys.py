"""Blender properties made from the settings' schema, which says all that there is to say of a key."""

from __future__ import annotations

import typing
from pathlib import Path
from typing import Any

import bpy

from ..shot.schema import Key, Part, parts

Items = tuple[tuple[str, str, str], ...]

_SHORT = {"cpu", "gpu", "rgb", "eevee"}  # names that are written in capitals


def prop(kind: type, name: str, first: tuple[str, str, str] | None = None, **options: Any) -> Any:
    """The Blender property of the key `name` of a dataclass of settings.

    Parameters
    ----------
    first
        A further choice (identifier, name, description) before the schema's, which becomes the default.
    options
        Given on to `bpy.props`, in place of what the schema says.
    """
    part = next(part for part in parts(kind) if part.name == name)
    about = {"name": label(name), "description": sentence(part.key.described())}
    if part.key.choices is not None:
        return bpy.props.EnumProperty(**{**about, **_choice(part, first), **options})
    make, more = _plain(part)
    return make(**{**about, **more, **options})


def items(key: Key) -> Items:
    """The choices of a key as those of an enumeration."""
    return tuple((name, label(name), sentence(words)) for name, words in key.names().items())


def label(name: str) -> str:
    """``thermal_low`` -> ``Thermal low``, ``rgb`` -> ``RGB``."""
    return name.upper() if name in _SHORT else sentence(name.replace("_", " "))


def sentence(text: str) -> str:
    """Text with a capital first letter; Blender wants no period at its end."""
    return text[:1].upper() + text[1:]


def _choice(part: Part, first: tuple[str, str, str] | None) -> dict[str, Any]:
    known = items(part.key)
    if typing.get_origin(part.type) is tuple:
        return {"items": known, "options": {"ENUM_FLAG"}, "default": set(part.default)}
    return {"items": (first, *known) if first else known, "default": first[0] if first else part.default}


def _plain(part: Part) -> tuple[Any, dict[str, Any]]:
    """What makes the property of a key without choices, and what it is given."""
    if part.type is str:
        return bpy.props.StringProperty, {"default": part.default}
    if part.type is Path:
        return bpy.props.StringProperty, {"default": str(part.default), "subtype": "DIR_PATH"}
    if part.type is bool:
        return bpy.props.BoolProperty, {"default": part.default}
    make = {int: bpy.props.IntProperty, float: bpy.props.FloatProperty}[part.type]
    low = part.key.at_least if part.key.at_least is not None else part.key.above
    bounds = {"min": low, "max": part.key.at_most}
    return make, {"default": part.default} | {name: at for name, at in bounds.items() if at is not None}
