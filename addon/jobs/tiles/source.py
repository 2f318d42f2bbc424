"""Tiles of one source of a shot: selected, fetched and decoded until all selected tiles can be shown."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ... import files
from ...errors import InputError, input_error
from ...progress import Progress
from ...shot.sections import TileSettings
from ...shot.shot import Shot
from ...shot.tiles import tile_terms
from ...shot.tiles.tile_terms import Use
from ...tiles import decoded, notices
from ...tiles.decoded import TileSummary
from ...tiles.policies import Policy
from ...tiles.sources import MissingError
from . import decode
from .access import TileAccess
from .decode import DecodeTask

if TYPE_CHECKING:
    from ...tiles.cut import TileSelection
    from ...tiles.loader import Loader
    from ...tiles.sources import Source

_TRIES = 8  # maximum selections; each excludes undecodable tiles, or knows more triangles


def open_tileset(shot: Shot, number: int, access: TileAccess) -> Source:
    """Open a source of a scene.

    Raises
    ------
    InputError
        The source does not exist, or is not allowed.
    """
    from ...tiles.sources import open_source

    tiles, folder = shot.settings.tiles, shot.settings.path.parent
    place, network = tiles.sources[number], access.network()
    if tiles.root and network.root is None:
        network = replace(network, root=folder / tiles.root)
    near = folder / place
    return open_source(str(near) if near.exists() else place, network)


def to_scene(shot: Shot) -> tuple[float | None, NDArray[np.float64]]:
    """Compute the height of the geoid at a scene, m, and the matrix (4, 4) from Earth-centred metres.

    The height is None for a run with heights above the ellipsoid.

    Raises
    ------
    InputError
        The height is unknown.
    """
    from ...tiles import geoid
    from ...tiles.place import ecef_to_frame

    settings, frame = shot.settings, shot.local_frame
    if shot.run.vertical != "orthometric":
        return None, ecef_to_frame(frame)
    if settings.tiles.geoid is not None:
        return settings.tiles.geoid, ecef_to_frame(frame, settings.tiles.geoid)
    found = geoid.find()
    if found is None:
        raise input_error(settings.path, f"tiles.geoid is left out, and {geoid.REMEDY}")
    height, *slope = found.plane(frame)
    return height, ecef_to_frame(frame, height, (slope[0], slope[1]))


@dataclass(frozen=True)
class PreparedTiles:
    """The part of a cut from one source.

    Attributes
    ----------
    names
        Names of decoded tiles.
    credits
        A credit for each tile.
    missing
        Names and reasons of missing tiles.
    empty
        Number of tiles without triangles and points.
    triangles
        Triangles of all tiles.
    advised
        The screen-space error is the policy's recommendation.
    """

    selection: TileSelection
    names: list[str]
    credits: list[str]
    missing: list[str]
    empty: int
    triangles: int
    policy: Policy
    advised: bool


class TileSource:
    """Tiles of one source."""

    def __init__(
        self,
        shot: Shot,
        number: int,
        folder: Path,
        matrix: NDArray[np.float64],
        access: TileAccess,
        uses: Sequence[Use],
    ) -> None:
        from ...tiles.cut import Budget, Views, pixels
        from ...tiles.loader import Loader

        self.settings, self.folder = shot.settings.tiles, folder
        source = open_tileset(shot, number, access)
        self.policy = source.policy
        tile_terms.check_source(shot.settings, number, self.policy, uses)
        self.advised = (
            self.policy.pixel_error > 0.0
            and self.settings.max_screen_space_error == TileSettings().max_screen_space_error
        )
        self.error = self.policy.pixel_error if self.advised else self.settings.max_screen_space_error
        self.loader: Loader = Loader(source)
        self.matrix = matrix
        view_set, heights, halves, eyes = shot.visibility.all_views()
        earth = self.matrix if all(view.perspective for view in shot.paths) else None
        self.views = Views(view_set, pixels(heights, halves), eyes, earth)
        megabytes = self.settings.max_size * 1_000_000
        self.budget = Budget(self.settings.max_tiles, megabytes, self.settings.max_triangles)
        self.files: dict[int, str] = {}
        self._decoded: dict[str, TileSummary | None] = {}

    def prepare(self, progress: Progress) -> PreparedTiles:
        """Select, fetch and decode until all selected tiles can be shown."""
        from ...tiles.cut import select_tiles

        triangles: dict[int, int] = {}
        for _ in range(_TRIES):
            selection = select_tiles(
                self.loader,
                self.views,
                self.matrix,
                self.error,
                self.budget,
                shadows=True,
                on_content=self._store_content,
                triangles=triangles,
            )
            wanted, bad = self._contents(selection.contents.tolist())
            failed = decode.run(list(wanted.values()), progress)
            bad |= {number: failed[each.name] for number, each in wanted.items() if each.name in failed}
            for number, reason in bad.items():
                name = self.loader.source.name(self.loader.content_uri(number))
                named = reason if reason.startswith(name) else f"{name}: {reason}"
                self.loader.tree.broken[int(self.loader.tree.content[number, 0])] = named
            counts = {
                number: about.triangles if (about := self._summary(each)) else 0
                for number, each in wanted.items()
            }
            triangles |= counts
            if not bad and sum(counts.values()) <= self.settings.max_triangles:
                break
        self.loader.source.close()
        there = {each.out: about for each in wanted.values() if (about := self._summary(each))}
        return PreparedTiles(
            selection,
            [Path(out).name for out in there],
            list(self._credits(there.values())),
            sorted(self.loader.tree.broken.values()),
            sum(not (about.triangles or about.points) for about in there.values()),
            sum(about.triangles for about in there.values()),
            self.policy,
            self.advised,
        )

    def _contents(self, numbers: list[int]) -> tuple[dict[int, DecodeTask], dict[int, str]]:
        """List decoding tasks, and reasons for contents that are invalid or whose resources are missing."""
        wanted, bad = dict[int, DecodeTask](), dict[int, str]()
        for number in numbers:
            try:
                wanted[number] = self._content(number)
            except (MissingError, _WrongError) as error:
                bad[number] = str(error)
        return wanted, bad

    def _store_content(self, content: int, data: bytes) -> None:
        """Store a content under the hash of its bytes."""
        self.files[content] = self._store(data)

    def _store(self, data: bytes) -> str:
        path = self.folder / "content" / hashlib.sha256(data).hexdigest()
        files.write_cached(path, data)
        return str(path)

    def _content(self, content: int) -> DecodeTask:
        """Make the decoding task of a content."""
        tree = self.loader.tree
        tile, document = int(tree.content[content, 0]), tree.documents[int(tree.content[content, 1])]
        earth = tree.matrix_of(tile)
        matrix, path = self.matrix @ earth, self.files[content]
        key = hashlib.sha256(Path(path).name.encode() + _rounded_bytes(matrix) + document.up_axis.encode())
        uri = self.loader.content_uri(content)
        return DecodeTask(
            file=path,
            name=self.loader.source.name(uri),
            matrix=matrix.tolist(),
            earth_matrix=earth.tolist(),
            out=str(self.folder / f"{key.hexdigest()[:32]}{decoded.END}"),
            up_axis=document.up_axis,
            resources=self._fetch_resources(uri, path),
        )

    def _fetch_resources(self, uri: str, path: str) -> dict[str, str]:
        """Fetch the external resources of a content, by URI."""
        source, name = self.loader.source, self.loader.source.name(uri)
        data, found = Path(path).read_bytes(), dict[str, bytes]()
        while wanted := [each for each in _missing_resources(data, name, found) if each not in found]:
            found |= {each: source.read(source.resolve(uri, each)) for each in wanted}
        return {each: self._store(content) for each, content in found.items()}

    def _summary(self, content: DecodeTask) -> TileSummary | None:
        """Read the numbers of a decoded content once; None if it was not decoded or is damaged."""
        if self._decoded.get(content.out) is None:
            self._decoded[content.out] = decoded.read_summary(Path(content.out))
        return self._decoded[content.out]

    def _credits(self, shown: Iterable[TileSummary]) -> Iterator[str]:
        """List the notices of tiles, then of documents."""
        texts = [about.credit for about in shown]
        texts += [document.copyright for document in self.loader.tree.documents]
        for text in texts:
            yield from notices.split(text)


class _WrongError(Exception):
    """A content that cannot be read, reported as a missing tile."""


def _missing_resources(data: bytes, name: str, resources: dict[str, bytes]) -> list[str]:
    """List the external resources of a content that are not in `resources`.

    Raises
    ------
    _WrongError
        The content cannot be read.
    """
    from firetwin_core import tiles

    try:
        return tiles.list_missing_resources(data, name, resources)
    except (InputError, ValueError) as error:
        raise _WrongError(str(error)) from None


def _rounded_bytes(matrix: NDArray[np.float64]) -> bytes:
    """Round a matrix to 0.1 mm at 60 km, so that rounding errors do not change a tile's key."""
    return np.round(matrix, 9).tobytes()
