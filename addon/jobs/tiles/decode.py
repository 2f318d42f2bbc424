"""Decodes tiles in processes of their own, with limits of memory and time.

Decoders of compressed meshes read what strangers wrote. A process that dies or takes too much loses one tile:
it is named, and the others go on.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...progress import MessageCallback, Progress, silent
from ...tiles import decoded
from .. import worker

_MEMORY = 3 << 30
"""bytes of address space of a decoding process."""
_SECONDS = 60.0
"""s that a tile may take."""


@dataclass(frozen=True)
class DecodeTask:
    """What is to be decoded.

    Attributes
    ----------
    file, resources
        File of the content, and the files that it refers to, by URI.
    name
        For messages.
    matrix, earth_matrix
        (4, 4) rows: the content's frame to the scene's, and to the Earth-centred one.
    up_axis
        `asset.gltfUpAxis` of the tileset.
    out
        File that the arrays are written to.
    """

    file: str
    name: str
    matrix: list[list[float]]
    earth_matrix: list[list[float]]
    out: str
    up_axis: str = "Y"
    resources: dict[str, str] | None = None


def run(contents: Sequence[DecodeTask], progress: Progress = silent) -> dict[str, str]:
    """Decode contents whose `out` is not there, or not whole.

    Returns
    -------
    Reasons by name, of those that could not be decoded.
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
    """Decode one after the other; a process that dies is replaced behind the tile that it died of."""
    bad: dict[str, str] = {}
    first = 0
    while first < len(contents):
        reached = 0

        def count(done: int, total: int, what: str = "", note: str = "", first: int = first) -> None:
            nonlocal reached
            reached = done
            follow(first + done)

        tasks = [asdict(each) for each in contents[first:]]
        try:
            about = {"contents": tasks, "memory": _MEMORY}
            bad |= worker.run(f"{__name__}:in_process", about, count, blender=False, patience=_SECONDS)
            return bad
        except worker.EndedError as error:
            bad[contents[first + reached].name] = f"decoding {error}"
            first += reached + 1
    return bad


def in_process(
    contents: list[dict[str, Any]], progress: Progress, tell: MessageCallback, memory: int = _MEMORY
) -> dict[str, str]:
    """Decode within `memory` bytes; worker side. Reasons by name, of those that are refused."""
    from firetwin_core import tiles

    _limit(memory)
    bad = {}
    for number, about in enumerate(contents):
        progress(number, len(contents))
        each = DecodeTask(**about)
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


def _limit(memory: int) -> None:
    """Limit this process's memory, where the system can: Windows has no such module."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
