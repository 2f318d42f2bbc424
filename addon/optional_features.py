"""Optional features: packages that an installation can omit, each for one kind of user.

Only its command and panel import such a package, after a check with `is_installed`.
"""

from __future__ import annotations

from pathlib import Path

COMMANDS = {
    "allocate": "allocation",
    "brief": "brief",
    "dataset": "dataset",
    "deliver": "delivery",
    "edit": "edit",
    "export": "export",
    "farm": "farm",
    "import": "camera_import",
}
"""Package of each command that needs an optional feature."""


def is_installed(package: str) -> bool:
    """Check whether this installation has the package of an optional feature."""
    return (Path(__file__).parent / package / "__init__.py").is_file()
