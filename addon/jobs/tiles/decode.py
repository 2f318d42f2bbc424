"""Decoding of tiles in separate processes, with limits on memory and time.

Decoders of compressed meshes read untrusted files. If a process crashes or exceeds a limit, one tile is lost:
it is reported, and the others are decoded.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

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
        parts = [pool.submit(_decode, left[way::ways], partial(follow, way)) for way in range(ways)]
        for part in parts:
            bad |= part.result()
    return bad


def _decode(contents: list[DecodeTask], follow: Callable[[int], None]) -> dict[str, str]:
    """Decode in sequence; after a crash a new process continues with the next tile."""
    bad: dict[str, str] = {}
    first = reached = 0

    def count(done: int, total: int, what: str = "", note: str = "") -> None:
        nonlocal reached
        reached = first + done
        follow(reached)

    def fail(reason: str) -> None:
        bad[contents[reached].name] = reason

    while first < len(contents):
        reached = first
        work = partial(in_process, contents[first:])
        try:
            worker.run(work, count, tell=fail, blender=False, patience=_SECONDS, size=_MEMORY)
            break
        except worker.EndedError as error:
            fail(f"decoding {error}")
            first = reached + 1
    return bad


def in_process(contents: list[DecodeTask], progress: Progress, tell: MessageCallback) -> None:
    """Decode; worker side. Tells why the content fails whose number is the last progress."""
    from firetwin_core import tiles

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
            tell(" ".join(str(error).split()) or "memory ran out")
    progress(len(contents), len(contents))
