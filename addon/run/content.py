"""What is in files: hashes by which baked and rendered files know their inputs again."""

from __future__ import annotations

import functools
import hashlib
import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def fingerprint(settings: dict[str, Any]) -> str:
    """Short hash of settings: equal exactly where their JSON is."""
    text = json.dumps(settings, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def inputs(folder: Path, leave_out: tuple[str, ...] = ()) -> dict[str, str]:
    """SHA-256 of each field of a run folder; of a field with one file per time, that of all their hashes.

    A file is read once per process while its size, time of change and place on the disk stay.

    Parameters
    ----------
    leave_out
        Fields (names without ending) that do not matter.
    """
    files = [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file()
        and not any(part.startswith(".") for part in path.relative_to(folder).parts)
        and Path(path.relative_to(folder).parts[0]).stem not in leave_out
    ]
    with ThreadPoolExecutor() as pool:
        hashes = list(pool.map(_known, files))
    parts: dict[str, list[str]] = {}
    for path, digest in zip(files, hashes, strict=True):
        parts.setdefault(path.relative_to(folder).parts[0], []).append(f"{path.name} {digest}")
    return {
        name: lines[0].split()[-1]
        if len(lines) == 1
        else hashlib.sha256("\n".join(lines).encode()).hexdigest()
        for name, lines in parts.items()
    }


def _known(path: Path) -> str:
    state = path.stat()
    return _hash(path, state.st_size, state.st_mtime_ns, state.st_ctime_ns, state.st_ino)


@functools.lru_cache(maxsize=100_000)
def _hash(path: Path, *_: int) -> str:
    return sha256(path)
