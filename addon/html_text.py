"""HTML text: text and data in pages, escaped so that no text of a file becomes a tag, script or reference."""

from __future__ import annotations

import base64
import html
import json
import unicodedata
from typing import Any

from .escaped import escaped

_IN_SCRIPT = {character: f"\\u{ord(character):04x}" for character in "<>&\u2028\u2029"}


def quote(text: object) -> str:
    """Escape text for an element or a quoted attribute, including control and bidirectional characters."""
    return html.escape(escaped(str(text)), quote=True)


def script_json(value: Any) -> str:
    """Encode JSON for a script element, without "</script>", "<!--" and bidirectional characters.

    Raises
    ------
    ValueError
        A number is NaN or infinite, which JSON cannot represent.
    """
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return "".join(_IN_SCRIPT.get(character) or _visible(character) for character in text)


def _visible(character: str) -> str:
    r"""Return ``\u202e`` for a bidirectional or invisible character, so that the page shows its code."""
    if character.isascii() or unicodedata.category(character) != "Cf":
        return character
    return escaped(character).replace("\\", "\\\\")


def data_uri(kind: str, content: bytes) -> str:
    """Encode content of a media type such as "image/png" as a data URI."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def size(count: int) -> str:
    """Format bytes of a page or a clip: ``420 kB``, ``2.8 MB``."""
    return f"{count / 1e6:.1f} MB" if count >= 999_500 else f"{count / 1e3:.0f} kB"
