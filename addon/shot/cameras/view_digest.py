"""A name for what the cameras of a shot see: files that follow the views bear it."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..shot import Shot


def of_views(shot: Shot, *words: str) -> str:
    """16 hexadecimal digits of the full shot's paths and filmed frames, its place, and these words."""
    shot = shot.full
    digest = hashlib.sha256("".join(words).encode() + repr(shot.ground.frame.latitude).encode())
    for path in shot.paths:
        for array in (path.position, path.rotation, path.halves, np.asarray([path.width, path.meet])):
            digest.update(np.ascontiguousarray(array, np.float64).tobytes())
        digest.update(np.ascontiguousarray(shot.filmed(path), np.int64).tobytes())
    return digest.hexdigest()[:16]
