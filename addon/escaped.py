"""Escaped text: names from files and other programs, made safe for a terminal and Blender's reports."""

from __future__ import annotations

import unicodedata

_HIDDEN = {"Cc", "Cf", "Zl", "Zp"}  # controls (C0, C1), formats (bidi, invisible), line and paragraph ends
_LONGEST, _END = 2000, 600  # characters of a message, and of its end with the remedy


def escaped(text: str) -> str:
    r"""Escape a text to one line: \xNN or \uNNNN for characters that move the cursor, colour or turn text."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_escape(c) if unicodedata.category(c) in _HIDDEN else c for c in text)


def message(text: str) -> str:
    """Escape a text and shorten it in the middle if it is too long."""
    text = escaped(text)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - _END]} [...] {text[-_END:]}"


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
