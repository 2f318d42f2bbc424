"""Tables that are stored as text in .blend files, which anybody may have changed."""

from __future__ import annotations

import json
from typing import Any


def table(text: Any) -> dict[str, Any]:
    """Parse a stored table; empty if the text is none."""
    content = parse(text)
    return content if isinstance(content, dict) else {}


def parse(text: Any) -> Any:
    """Parse a stored text; None if it is not JSON."""
    try:
        return json.loads(text)
    except (TypeError, ValueError, RecursionError):
        return None
