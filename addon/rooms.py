"""Rooms of the top floor: packages that an installation can omit.

Each room serves one kind of user. Only its command and panel import it, after a check with `is_installed`.
"""

from __future__ import annotations

from pathlib import Path

COMMANDS = {"allocate": "allocation", "brief": "brief", "farm": "farm"}
"""Package of each command that needs a room."""


def is_installed(package: str) -> bool:
    """Check whether this installation has a package of the top floor."""
    return (Path(__file__).parent / package / "__init__.py").is_file()
