"""Rooms of the top floor: packages that an installation can leave out.

Each serves one kind of user. Its own command and panel alone import it, after `is_installed`.
"""

from __future__ import annotations

from pathlib import Path

COMMANDS = {"allocate": "allocation", "brief": "brief", "farm": "farm"}
"""Package that each of these commands needs."""


def is_installed(package: str) -> bool:
    """Whether this installation has a room of the top floor."""
    return (Path(__file__).parent / package / "__init__.py").is_file()
