"""Copyright notices separated by semicolons, as in `asset.copyright` of glTF."""

from __future__ import annotations


def split(text: str) -> list[str]:
    """Split a text into its notices."""
    return [part for each in text.split(";") if (part := each.strip())]
