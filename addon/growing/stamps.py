"""Stamps of a model's files: size and modification time, found by polling.

Notifications of the system are silent on NFS, CIFS, Lustre and GPFS (watchdog, issues 395, 504 and 944), so
files are polled.
"""

from __future__ import annotations

import os
from pathlib import Path

Stamps = dict[str, tuple[int, int]]
"""Size (bytes) and modification time (ns), by path."""


def scan(path: Path) -> Stamps:
    """Return the stamps of a file, or of the files and zarr stores in a folder; empty if it is missing.

    A zarr store has the total size of its files, and their last modification time.
    """
    from ..run.models import zarr_store

    try:
        if path.is_file():
            return {str(path): _of_file(path)}
        if zarr_store.is_store(path):
            return {str(path): _of_store(path)}
        entries = sorted(path.iterdir())
    except OSError:
        return {}
    stamps: Stamps = {}
    for each in entries:
        try:
            if each.is_file():
                stamps[str(each)] = _of_file(each)
            elif zarr_store.is_store(each):
                stamps[str(each)] = _of_store(each)
        except OSError:  # removed meanwhile
            continue
    return stamps


def _of_file(path: Path) -> tuple[int, int]:
    state = path.stat()
    return state.st_size, state.st_mtime_ns


def _of_store(path: Path) -> tuple[int, int]:
    size = latest = 0
    for folder, _, names in os.walk(path):
        for name in names:
            one, changed = _of_file(Path(folder, name))
            size, latest = size + one, max(latest, changed)
    return size, latest
