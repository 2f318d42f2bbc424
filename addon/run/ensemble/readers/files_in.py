"""Files that a user names: files, and the files in folders."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


def files_in(paths: Iterable[Path]) -> list[Path]:
    """Collect these files and the files in these folders, in the order of their names."""
    inner = [sorted(path.iterdir()) if path.is_dir() else [path] for path in paths]
    return [each for files in inner for each in files if each.is_file()]
