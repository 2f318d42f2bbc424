"""Escaped text: names from files and other programs, made safe for a terminal and Blender's reports."""

from __future__ import annotations

import re
import unicodedata

_HIDDEN = {"Cc", "Cf", "Zl", "Zp"}  # controls (C0, C1), formats (bidi, invisible), line and paragraph ends
_LONGEST, _END = 2000, 600  # characters of a message, and of its end with the remedy


HIDDEN = "..."
_USER = re.compile(r"(?i)\b([a-z][a-z0-9+.-]*://)[^/?#\s'\"@]*(?:@[^/?#\s'\"@]*)*@")
SECRETS = frozenset(
    (
        *("key", "api_key", "apikey", "api-key", "subscription-key", "session", "sessionid"),
        *("token", "access_token", "auth", "authorization", "password", "secret"),
        *("sig", "signature", "x-amz-signature", "x-amz-credential", "x-amz-security-token"),
        *("x-goog-signature", "x-goog-credential", "policy", "key-pair-id"),
    )
)
"""Parameters of URLs that are secrets, in lower case."""
ANY_SECRET = "|".join(map(re.escape, sorted(SECRETS, key=len, reverse=True)))
"""Regular expression of these names, the longest first."""
_PARAMETER = re.compile(rf"(?i)([?&](?:{ANY_SECRET})=)" r"(?!\$\{)[^&\s'\"#<>,;}]+")


def without_secrets(text: str) -> str:
    """Hide user names, passwords and keys of the URLs in a text."""
    if "://" not in text:
        return text
    return _PARAMETER.sub(rf"\1{HIDDEN}", _USER.sub(rf"\1{HIDDEN}@", text))


def escaped(text: str) -> str:
    r"""Escape a text to one line: \xNN or \uNNNN for characters that move the cursor, colour or turn text."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(_escape(c) if unicodedata.category(c) in _HIDDEN else c for c in text)


def message(text: str) -> str:
    """Escape a text, hide secrets of URLs in it, and shorten it in the middle if it is too long."""
    text = escaped(without_secrets(text))
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - _END]} [...] {text[-_END:]}"


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
