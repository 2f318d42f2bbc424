"""Escaped text: names from files and other programs, made safe for a terminal and Blender's reports."""

from __future__ import annotations

import unicodedata

_HIDDEN = {"Cc", "Cf", "Zl", "Zp"}  # controls (C0, C1), formats (bidi, invisible), line and paragraph ends
_LONGEST, _END = 2000, 600  # characters of a message; of its end, which says what to do


def escaped(text: str) -> str:
    r"""The text in one line, with \xNN or \uNNNN in place of what moves the cursor, colours or turns text."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_escape(c) if unicodedata.category(c) in _HIDDEN else c for c in text)


def message(text: str) -> str:
    """An escaped text of bounded length: of a longer one the middle is left out."""
    text = escaped(text)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - _END]} [...] {text[-_END:]}"


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
