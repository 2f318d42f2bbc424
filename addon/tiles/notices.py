"""Copyright notices in one text, as `asset.copyright` of glTF has them: semicolons separate them."""

from __future__ import annotations


def split(text: str) -> list[str]:
    """Notices of a text."""
    return [part for each in text.split(";") if (part := each.strip())]
