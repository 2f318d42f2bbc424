"""Settings in the .blend file: a property group per section of a scene file, generated from the schema.

`scene.firetwin.forest.budget` is the key `budget` of [forest]. Lists of tables, except cameras and comparison
runs, are stored as the text of their tables.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import bpy

from ..shot.schema import Field, fields, summary
from ..shot.settings import Settings
from . import changed_settings, keys
from .tables import from_text, to_text

NOT_HERE = ("path", "run", "cache", "runs", "cameras")
"""Fields of `Settings` that are not sections: the panel stores them separately."""


@functools.cache
def sections() -> tuple[Field, ...]:
    """Return the sections of a scene file in order."""
    return tuple(part for part in fields(Settings) if part.table and not part.tables)


def top_level_keys() -> tuple[Field, ...]:
    """Return keys before all sections, and lists of tables, except those that the panel stores separately."""
    parts = (part for part in fields(Settings) if not part.table or part.tables)
    return tuple(part for part in parts if part.name not in NOT_HERE)


def property_annotations(known: tuple[Field, ...], kind: type) -> dict[str, Any]:
    """Return property annotations of a group for keys of a dataclass."""
    annotations: dict[str, Any] = {"exact": bpy.props.StringProperty(options={"HIDDEN"})}
    for part in known:
        if part.tables:
            annotations[part.name] = bpy.props.StringProperty(
                name=keys.label(part.name), options={"HIDDEN"}, update=changed_settings.update_changes
            )
        elif part.table:
            annotations[part.name] = bpy.props.PointerProperty(type=group_class(part.table))
        else:
            annotations[part.name] = keys.create_property(
                kind, part.name, update=changed_settings.update_changes
            )
            if keys.has_switch(part):
                annotations[keys.USE + part.name] = keys.create_switch(
                    part, update=changed_settings.update_changes
                )
    return annotations


_groups: dict[type, type[bpy.types.PropertyGroup]] = {}


def group_class(kind: type) -> type[bpy.types.PropertyGroup]:
    """Return the property group class of a settings dataclass; the same class on every call."""
    if kind not in _groups:
        _groups[kind] = type(
            f"FIRETWIN_PG_{kind.__name__.lower()}",
            (bpy.types.PropertyGroup,),
            {
                "__doc__": keys.sentence(summary(kind)),
                "__annotations__": property_annotations(fields(kind), kind),
            },
        )
    return _groups[kind]


def group_classes() -> Iterator[type[bpy.types.PropertyGroup]]:
    """Return all property groups, nested groups first, in Blender's order of registration."""

    def inner(kind: type) -> Iterator[type[bpy.types.PropertyGroup]]:
        for part in fields(kind):
            if part.table and not part.tables:
                yield from inner(part.table)
        yield group_class(kind)

    for section in sections():
        if section.table:
            yield from inner(section.table)


def put(group: bpy.types.PropertyGroup, known: tuple[Field, ...], values: Any) -> None:
    """Set a group to the values of a dataclass."""
    for part in known:
        value = getattr(values, part.name)
        if part.tables:
            setattr(group, part.name, to_text(part, value))
        elif part.table:
            put(getattr(group, part.name), fields(part.table), value)
        else:
            keys.put(group, part, value)


def take(group: bpy.types.PropertyGroup, parts: tuple[Field, ...], values: Any) -> Any:
    """Return the dataclass with the values that a group shows.

    Raises
    ------
    Error
        A typed text is invalid.
    """
    taken: dict[str, Any] = {}
    for part in parts:
        if part.tables:
            taken[part.name] = from_text(part, getattr(group, part.name))
        elif part.table:
            inner = getattr(values, part.name)
            taken[part.name] = take(getattr(group, part.name), fields(part.table), inner)
        else:
            taken[part.name] = keys.take(group, part)
    return replace(values, **taken)
