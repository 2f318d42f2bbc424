"""Run lengths of masks as COCO stores them: columns first, beginning with the length of the background."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_FIRST = 48  # character of the value 0
_BITS = 5  # of a character; a further bit is set if another character follows


def encode(mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Encode a mask (h, w) as COCO's compressed run lengths: `size` and `counts`."""
    flat = np.asarray(mask, bool).ravel(order="F")
    edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    start = [0, 0] if flat.size and flat[0] else [0]
    lengths = np.diff(np.concatenate([start, edges, [flat.size]]))
    return {"size": [int(size) for size in mask.shape], "counts": _compress(lengths)}


def _compress(lengths: NDArray[np.int64]) -> str:
    """Write each length, from the fourth as difference to the second before it, in characters of 5 bits."""
    left = lengths.copy()
    left[3:] -= lengths[1:-2]
    columns, follows = [], np.ones(len(left), bool)
    while follows.any():
        low = left & 31
        left >>= _BITS
        more = np.where(low & 16, left != -1, left != 0)
        columns.append(np.where(follows, _FIRST + low + 32 * more, 0))
        follows &= more
    letters = np.stack(columns, axis=1).astype(np.uint8) if columns else np.empty(0, np.uint8)
    return letters[letters > 0].tobytes().decode("ascii")
