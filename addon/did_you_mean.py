"""Suggestions for mistyped names."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def suggestion(name: object, names: Iterable[str]) -> str:
    """End of an error message: ``; did you mean "head"?``, or empty if no name is similar."""
    matches = difflib.get_close_matches(str(name), list(names), n=1, cutoff=0.6)
    return f'; did you mean "{matches[0]}"?' if matches else ""
