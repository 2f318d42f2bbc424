"""Code fingerprint: hashes of the code that makes a product, so that files record it.

The code of an aspect is the folder of its name in ``scene``, and the folder of its name next to ``scene`` if
there is one. All aspects share the modules directly in ``scene``, those in `EVERYWHERE`, the cameras' rigs
with the files that they read, and the compiled core.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import sys
from collections.abc import Iterable
from pathlib import Path

import firetwin_core

from ...run.content import sha256
from ..cameras import rigs
from . import Camera

EVERYWHERE = (
    "scene",
    "scene/forest/biomes",
    "blender",
    "geometry",
    "run",
    "shot",
    "shot/cameras",
    "shot/fire",
    "shot/light",
    "shot/runs",
    "shot/schema",
    "shot/sections",
    "shot/settings",
    "shot/stations",
    "shot/surface",
    "shot/terrain",
    "shot/tiles",
    "shot/cameras/rigs/_key.py",
    "shot/cameras/rigs/_lens.py",
)
PACKAGE = Path(__file__).parents[2]


def hashes(aspects: Iterable[str], cameras: Iterable[Camera], *more: str | Path) -> dict[str, str]:
    """Hashes of the code that makes these aspects for these cameras, by folder or file.

    Parameters
    ----------
    more
        Further files: of the package, such as "render/engine.py", or of other places.
    """
    cameras = list(cameras)
    wanted = [place for name in sorted(aspects) for place in (name, f"scene/{name}")]
    folders = [place for place in wanted if (PACKAGE / place).is_dir()]
    rigs = {file for camera in cameras for file in _modules(type(camera.rig))}
    places = [PACKAGE / place for place in (*EVERYWHERE, *folders, *rigs, *more)]
    read = {path.name: sha256(path)[:16] for camera in cameras for path in camera.rig.input_files()}
    return {"core": _core()} | dict(sorted(map(_hash, places))) | read


def _modules(rig: type) -> set[str]:
    """Files of a rig and of other rigs that its module imports."""
    mine = sys.modules[rig.__module__]
    others = (getattr(member, "__module__", None) or "" for member in vars(mine).values())
    names = {name for name in others if name.startswith(f"{rigs.__name__}.")}
    return {inspect.getfile(sys.modules[name]) for name in {rig.__module__, *names}}


@functools.cache
def _hash(place: Path) -> tuple[str, str]:
    """Name and hash of a file, or of a folder's own modules; the same on all systems."""
    name = place.relative_to(PACKAGE).as_posix() if place.is_relative_to(PACKAGE) else place.name
    digest = hashlib.sha256()
    for path in sorted(place.glob("*.py")) if place.is_dir() else [place]:
        digest.update(path.name.encode() + b"\0" + path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return name, digest.hexdigest()[:16]


@functools.cache
def _core() -> str:
    return sha256(Path(firetwin_core.__file__))[:16]
