"""Secrets of URLs, which must not reach names, cache keys, messages and logs."""

from __future__ import annotations

import logging
import re
from urllib.parse import parse_qsl, urlencode, urlsplit, urlunsplit

from ...escaped import ANY_SECRET, HIDDEN, SECRETS, without_secrets

_NAMED = re.compile(
    rf"(?i)\b({ANY_SECRET})"
    r"""(["']?\s*[=:]\s*["']?)[^&\s"'#<>,;}]+"""
)
_BEARER = re.compile(r"(?i)\b(bearer\s+)[^\s\"',;]+")
_SHORTEST = 4  # characters; shorter values are not redacted


def split(url: str) -> tuple[str, dict[str, str]]:
    """Split a URL into the URL without secrets and fragment, and the secrets by parameter."""
    parts = urlsplit(url)
    every = parse_qsl(parts.query, keep_blank_values=True)
    secrets = {name: value for name, value in every if name.lower() in SECRETS}
    if not secrets:
        return urlunsplit(parts._replace(fragment="")), {}
    rest = [(name, value) for name, value in every if name not in secrets]
    return urlunsplit(parts._replace(query=urlencode(rest), fragment="")), secrets


def with_secrets(url: str, secrets: dict[str, str]) -> str:
    """Add secrets to a URL."""
    if not secrets:
        return url
    return f"{url}{'&' if urlsplit(url).query else '?'}{urlencode(secrets)}"


class Redactor(logging.Filter):
    """Filter that hides secrets in texts and log records."""

    def __init__(self) -> None:
        super().__init__()
        self._values: set[str] = set()

    def add(self, *values: str) -> None:
        """Register values to hide."""
        for value in values:
            if len(value) >= _SHORTEST:
                self._values |= {value, urlencode({"": value})[1:]}

    def text(self, text: str) -> str:
        """Replace secrets in a text."""
        for value in sorted(self._values, key=len, reverse=True):
            text = text.replace(value, HIDDEN)
        text = without_secrets(text)
        text = _BEARER.sub(rf"\1{HIDDEN}", text)
        return _NAMED.sub(rf"\1\2{HIDDEN}", text)

    def filter(self, record: logging.LogRecord) -> bool:
        """Replace secrets in a log record."""
        record.msg, record.args = self.text(record.getMessage()), ()
        return True
