"""Texts of an export: times, and names of users in XML and HTML."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from xml.sax.saxutils import escape

from ..run import times

_FORBIDDEN = {"\ufffe", "\uffff", *map(chr, range(0xD800, 0xE000)), *map(chr, range(0x20))} - {"\t", "\n"}


def iso(when: datetime) -> str:
    """Format a time as ISO 8601 in UTC, with microseconds if there are any."""
    return times.iso(when, "auto")


def xml(value: str) -> str:
    """Escape a text for XML content and attributes, without characters that XML 1.0 forbids."""
    return escape("".join(each for each in value if each not in _FORBIDDEN), {'"': "&quot;"})


def html(lines: Iterable[str]) -> str:
    """Format lines of text as HTML."""
    return "<br/>".join(map(xml, lines))
