"""Caches of compiled kernels: folders on the local disk, and a record of the cards that have compiled.

NVIDIA's drivers keep compiled kernels in two caches: one of CUDA, and one of OptiX, whose behaviour on a
network share is undefined (documentation of OPTIX_CACHE_PATH). On Linux Firetwin sets both to folders in
/var/tmp, which is local and outlasts a restart. Farm tasks with private or shared home folders thus compile
once per machine.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path

from .. import files
from .cards import Card

SIZE = 4 << 30
"""Size limit of CUDA's cache, bytes; a kernel larger than the limit is not kept."""
_RECORD = "firetwin-compiled.json"


def environment(given: Mapping[str, str], place: Path = Path("/var/tmp")) -> dict[str, str]:
    """Return the variables that a process needs for local caches; those in `given` have priority.

    Empty on other systems than Linux, whose caches are local, and without an NVIDIA driver.
    """
    if sys.platform != "linux" or not any(map(os.path.exists, ("/dev/nvidiactl", "/dev/dxg"))):
        return {}
    own = _own_folder(place / f"firetwin-gpu-{os.getuid()}")
    if own is None:
        return {}
    wanted = {
        "CUDA_CACHE_PATH": str(own / "cuda"),
        "OPTIX_CACHE_PATH": str(own / "optix"),
        "CUDA_CACHE_MAXSIZE": str(SIZE),
    }
    return {name: value for name, value in wanted.items() if name not in given}


def _own_folder(path: Path) -> Path | None:
    """Create a private folder; None if it belongs to someone else or cannot be created."""
    try:
        path.mkdir(mode=0o700, exist_ok=True)
        about = path.lstat()
    except OSError:
        return None
    return path if path.is_dir() and not path.is_symlink() and about.st_uid == os.getuid() else None


def folders(given: Mapping[str, str]) -> list[Path]:
    """List the folders of the caches of CUDA and OptiX."""
    home = Path.home()
    if sys.platform == "win32":
        local = Path(given.get("LOCALAPPDATA", home / "AppData/Local"))
        usual = home / "AppData/Roaming/NVIDIA/ComputeCache", local / "NVIDIA/OptixCache"
    else:
        usual = home / ".nv/ComputeCache", Path(f"/var/tmp/OptixCache_{given.get('USER', 'root')}")
    names = "CUDA_CACHE_PATH", "OPTIX_CACHE_PATH"
    return [Path(given.get(name) or path) for name, path in zip(names, usual, strict=True)]


def size(folder: Path) -> int:
    """Sum the sizes of the files in a folder, bytes; 0 if it does not exist."""
    return sum(each.stat().st_size for each in folder.rglob("*") if each.is_file())


def is_compiled(card: Card, blender: str, given: Mapping[str, str]) -> bool:
    """Check whether a card has compiled the kernels of a version of Blender, and the cache remains."""
    place, _ = folders(given)
    return _key(card, blender) in _read(place) and any(each.is_dir() for each in place.glob("*"))


def record_compiled(cards: list[Card], blender: str, given: Mapping[str, str]) -> None:
    """Record that these cards have compiled the kernels of a version of Blender."""
    place, _ = folders(given)
    known, new = _read(place), [_key(card, blender) for card in cards]
    if not set(new) <= set(known):
        place.mkdir(parents=True, exist_ok=True)
        files.write_text(place / _RECORD, json.dumps(sorted({*known, *new}), indent=1) + "\n")


def _key(card: Card, blender: str) -> str:
    return f"{card.name}, {card.architecture}, driver {card.driver}, Blender {blender}"


def _read(place: Path) -> list[str]:
    try:
        found = files.read_json(place / _RECORD)
    except (OSError, ValueError):
        return []
    return found if isinstance(found, list) else []
