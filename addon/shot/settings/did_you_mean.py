"""What a mistyped name may have been."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def suggestion(name: object, names: Iterable[str]) -> str:
    """End of a message: ``; did you mean "head"?``, or nothing where no name is near."""
    found = difflib.get_close_matches(str(name), list(names), n=1, cutoff=0.6)
    return f'; did you mean "{found[0]}"?' if found else ""
