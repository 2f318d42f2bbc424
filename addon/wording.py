"""Words that people read."""

from __future__ import annotations


def count(number: int, noun: str) -> str:
    """``1 picture``, ``1,200 pictures``."""
    return f"{number:,} {noun}" + ("" if number == 1 else "s")
