"""Tables that are stored as text in .blend files, which anybody may have changed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any

Shape = type | tuple["Shape", ...] | list["Shape"]
"""Type of a value; tuple of the shapes of a list of this length; list with the shape of all its values."""


def table(text: Any) -> dict[str, Any]:
    """Parse a stored table; empty if the text is none."""
    content = parse(text)
    return content if isinstance(content, dict) else {}


def parse(text: Any) -> Any:
    """Parse a stored text; None if it is not JSON."""
    try:
        return json.loads(text)
    except (TypeError, ValueError, RecursionError):
        return None


def record(text: Any, shapes: Mapping[str, Shape]) -> dict[str, Any]:
    """Parse a stored table with these keys; a value of another shape is replaced by an empty one.

    Parameters
    ----------
    shapes
        Shape of each key. `datetime` is a text in ISO format.
    """
    content = table(text)
    return {
        name: content[name] if _has_shape(content.get(name), shape) else _empty(shape)
        for name, shape in shapes.items()
    }


def _empty(shape: Shape) -> Any:
    return "" if shape in (str, datetime) else [] if isinstance(shape, list) else None


def _has_shape(value: Any, shape: Shape) -> bool:
    if isinstance(shape, list):
        return isinstance(value, list) and all(_has_shape(each, shape[0]) for each in value)
    if isinstance(shape, tuple):
        return isinstance(value, list) and len(value) == len(shape) and all(map(_has_shape, value, shape))
    if shape is datetime:
        try:
            return datetime.fromisoformat(value).tzinfo is not None
        except (TypeError, ValueError):
            return False
    return isinstance(value, (int, float) if shape is float else shape)
