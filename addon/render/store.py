"""What is finished in an output folder: which files there are, what made them, and how to tell.

``manifest.json`` holds, for every finished file, its size, its SHA-256 and the fingerprint of the settings
that made it, and for every fingerprint these settings in full. It is rewritten whole, under a lock, to a
temporary file that then takes its name: valid at any moment, and many processes may share one folder.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ..errors import input_error
from ..run.content import fingerprint, sha256

NAME = "manifest.json"


def load(out: Path) -> dict[str, Any]:
    """The manifest of an output folder, an empty one where there is none.

    Raises
    ------
    InputError
        The file is there and is not a manifest.
    """
    path = out / NAME
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {"format": 1, "settings": {}, "files": {}}
    except (OSError, ValueError) as error:
        raise input_error(path, getattr(error, "lineno", 0), getattr(error, "colno", 0), _BROKEN) from None
    if not isinstance(manifest, dict) or manifest.get("format") != 1:
        raise input_error(path, 0, 0, _BROKEN)
    return manifest


_BROKEN = "is not a manifest of Firetwin; move it away, or render to another folder"


def add(out: Path, settings: dict[str, Any], files: dict[str, dict[str, Any]]) -> None:
    """Enter finished files (path -> what `describe` returned and more), all made with these `settings`."""
    key = fingerprint(settings)
    with _locked(out):
        manifest = load(out)
        manifest["settings"][key] = settings
        for path, entry in files.items():
            manifest["files"][path] = entry | {"settings": key}
        used = {entry["settings"] for entry in manifest["files"].values()}
        manifest["settings"] = {k: v for k, v in manifest["settings"].items() if k in used}
        manifest["files"] = dict(sorted(manifest["files"].items()))
        _write(out / NAME, json.dumps(manifest, indent=1) + "\n")


def intact(out: Path, manifest: dict[str, Any], key: str, paths: Iterable[str]) -> bool:
    """Whether all these files were made with the settings of fingerprint `key` and are as they were then."""
    for path in paths:
        entry = manifest["files"].get(path)
        if entry is None or entry["settings"] != key:
            return False
        try:
            if (out / path).stat().st_size != entry["bytes"] or sha256(out / path) != entry["sha256"]:
                return False
        except OSError:
            return False
    return True


def describe(path: Path) -> dict[str, Any]:
    """Size and hash of a finished file."""
    return {"bytes": path.stat().st_size, "sha256": sha256(path)}


def publish(part: Path, path: Path) -> None:
    """Give a finished temporary file its name, once what is in it has reached the disk."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with part.open("rb") as file:
        os.fsync(file.fileno())
    part.replace(path)


def _write(path: Path, text: str) -> None:
    for left in path.parent.glob(f"{path.name}.part-*"):  # of a killed process: who writes holds the lock
        left.unlink(missing_ok=True)
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    part.write_text(text, encoding="utf-8")
    publish(part, path)


@contextlib.contextmanager
def _locked(out: Path) -> Iterator[None]:
    """Hold the folder's lock; where the system has no such locks, one process at a time may render."""
    try:
        import fcntl
    except ImportError:
        yield
        return
    with (out / ".lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
