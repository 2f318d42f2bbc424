"""Days in columns of tables and layers."""

from __future__ import annotations

import re
from datetime import UTC, date, datetime
from typing import Any


def parse_day(value: Any) -> str:
    """Parse a day, in ISO 8601, as 5/4/2023 (month first), or in ms since 1970; empty if there is none."""
    if isinstance(value, int | float) and 1e11 < value < 1e14:
        return datetime.fromtimestamp(value / 1e3, UTC).date().isoformat()
    text = str(value or "").strip()
    if re.fullmatch(r"\d{12,13}", text):
        return parse_day(int(text))
    if match := re.match(r"(\d{1,2})/(\d{1,2})/(\d{4})\b", text):
        text = f"{match[3]}-{int(match[1]):02d}-{int(match[2]):02d}"
    try:
        return date.fromisoformat(text[:10].replace("/", "-")).isoformat()
    except ValueError:
        return ""
