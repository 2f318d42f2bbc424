"""Digest of the views of a shot: files that depend on the views have it in their names."""

from __future__ import annotations

import hashlib

import numpy as np

from .shot import Shot


def of_views(shot: Shot, *words: str) -> str:
    """Hash the full shot's paths, filmed frames and place, and these words, to 16 hexadecimal digits."""
    shot = shot.full
    digest = hashlib.sha256("".join(words).encode() + repr(shot.ground.frame.latitude).encode())
    for path in shot.paths:
        for array in (path.position, path.rotation, path.halves, np.asarray([path.width, path.meet])):
            digest.update(np.ascontiguousarray(array, np.float64).tobytes())
        digest.update(np.ascontiguousarray(shot.filmed(path), np.int64).tobytes())
    return digest.hexdigest()[:16]
