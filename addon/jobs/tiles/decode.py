"""Decoding of tiles in separate processes, with limits on memory and time.

Decoders of compressed meshes read untrusted files. If a process crashes or exceeds a limit, one tile is lost:
it is reported, and the others are decoded.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ... import limits
from ...errors import InputError
from ...progress import MessageCallback, Progress, silent
from ...tiles import decoded
from .. import worker

_MEMORY = limits.TILE_MEMORY
"""Limit on the memory of a decoding process, bytes."""
_SECONDS = float(limits.TILE_SECONDS)
"""Limit on the time of a tile, s."""


@dataclass(frozen=True)
class DecodeTask:
    """A content to decode.

    Attributes
    ----------
    file, resources
        File of the content, and the files that it refers to, by URI.
    name
        Name of the content, for messages.
    matrix, earth_matrix
        (4, 4) rows: from the content's frame to the scene, and to Earth-centred metres.
    up_axis
        `asset.gltfUpAxis` of the tileset.
    out
        File for the decoded arrays.
    """

    file: str
    name: str
    matrix: list[list[float]]
    earth_matrix: list[list[float]]
    out: str
    up_axis: str = "Y"
    resources: dict[str, str] | None = None


def run(contents: Sequence[DecodeTask], progress: Progress = silent) -> dict[str, str]:
    """Decode contents whose `out` is missing or incomplete.

    Returns
    -------
    Reasons of failures, by name.
    """
    left = [each for each in contents if decoded.read_summary(Path(each.out)) is None]
    ways = min(max(os.cpu_count() or 1, 1), max(len(left) // 8, 1))
    done, bad = [0] * ways, dict[str, str]()

    def follow(way: int, count: int) -> None:
        done[way] = count
        progress(sum(done), len(left), "tiles decoded")

    with ThreadPoolExecutor(ways) as pool:
        parts = [
            pool.submit(_decode, left[way::ways], lambda n, way=way: follow(way, n)) for way in range(ways)
        ]
        for part in parts:
            bad |= part.result()
    return bad


def _decode(contents: list[DecodeTask], follow: Any) -> dict[str, str]:
    """Decode in sequence; after a crash a new process continues with the next tile."""
    bad: dict[str, str] = {}
    first = 0
    while first < len(contents):
        reached = 0

        def count(done: int, total: int, what: str = "", note: str = "", first: int = first) -> None:
            nonlocal reached
            reached = done
            follow(first + done)

        work = partial(in_process, contents[first:])
        try:
            bad |= worker.run(work, count, blender=False, patience=_SECONDS, size=_MEMORY)
            return bad
        except worker.EndedError as error:
            bad[contents[first + reached].name] = f"decoding {error}"
            first += reached + 1
    return bad


def in_process(contents: list[DecodeTask], progress: Progress, tell: MessageCallback) -> dict[str, str]:
    """Decode; worker side. Returns reasons of failures, by name."""
    from firetwin_core import tiles

    bad = {}
    for number, each in enumerate(contents):
        progress(number, len(contents))
        try:
            resources = {uri: Path(path).read_bytes() for uri, path in (each.resources or {}).items()}
            tile = tiles.decode(
                Path(each.file).read_bytes(),
                np.array(each.matrix),
                each.name,
                resources,
                np.array(each.earth_matrix),
                each.up_axis,
            )
            decoded.write(tile, Path(each.out), resources)
        except (InputError, ValueError, MemoryError) as error:
            bad[each.name] = " ".join(str(error).split()) or "memory ran out"
    progress(len(contents), len(contents))
    return bad
