"""Prepares a shot's 3-D Tiles: chooses them, fetches what is new, and decodes it to files of the cache.

Fetching happens in a process without Blender, decoding in processes of their own (`decode_tiles`). Blender
reads arrays that were checked.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..errors import Error, InputError, input_error
from ..progress import MessageCallback, Progress, count, no_message, share, silent
from ..shot import picture_credits, tile_cut, tile_terms
from ..shot.comparison import for_view
from ..shot.settings.settings import TileSettings
from ..shot.shot import Shot
from ..shot.source import ShotSource
from ..shot.terrain import land_use, tile_difference, tile_heights
from ..shot.terrain.tile_heights import TileHeights
from ..shot.tile_cut import TileCut
from ..shot.tile_terms import Use
from ..tiles import decoded, policies
from ..tiles.decoded import Summary
from ..tiles.policies import Policy
from ..tiles.sources import MissingError
from . import decode_tiles, worker
from .decode_tiles import Content
from .tile_access import TileAccess, from_plain, permitted

if TYPE_CHECKING:
    from ..tiles.cut import Choice
    from ..tiles.loader import Loader
    from ..tiles.sources import Source

PREVIEW_ERROR, PREVIEW_SIZE = 64.0, 200
"""Pixels and MB of a coarse choice."""
_TRIES = 8  # choices at most; each leaves out what could not be decoded, or knows more triangles
_NAMED = 6  # missing tiles that are named in messages; the manifest has all


def prepare(
    choice: ShotSource,
    views: Sequence[str] = (),
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    access: TileAccess | None = None,
    uses: Sequence[Use] = (),
    keep: bool = False,
    preview: bool = False,
) -> None:
    """Prepare the tiles of a scene; without sources there is nothing to do.

    Parameters
    ----------
    views
        Views that are built each by itself; empty: all cameras are built together.
    access
        How tiles may be had.
    uses
        What is to be made of them, besides what the scene's own settings say.
    keep
        Choices of servers' tiles stay as they are where they are whole, so that a film is continued with the
        tiles that it has, also without the server.
    preview
        A coarse choice (see `coarse`).

    Raises
    ------
    InputError
        A tileset is wrong, or refused, or its policy does not allow what is to be made of it.
    Error
        A tile is missing, and `access` is strict.
    """
    settings, access = choice.settings(), access or TileAccess()
    if not settings.tiles.sources:
        return
    every = [*tile_terms.of_scene(settings), *uses]
    offline = [] if access.online else [("work_offline", "--offline")]
    tile_terms.check(settings, [*every, *offline])
    about = {
        "choice": choice.plain(),
        "views": list(views),
        "access": permitted(access).plain(),
        "uses": [list(use) for use in every],
        "keep": keep,
        "preview": preview,
    }
    worker.run(f"{__name__}:in_process", about, progress, tell=tell, blender=False, stop=stop)


def coarse(shot: Shot) -> Shot:
    """The same shot with a coarse choice of tiles, for the window: soon there, and small."""
    tiles, terrain = shot.settings.tiles, shot.settings.terrain
    least, most = max(tiles.error, PREVIEW_ERROR), min(tiles.max_size, PREVIEW_SIZE)
    settings = replace(
        shot.settings,
        tiles=replace(tiles, error=least, max_size=most),
        terrain=replace(terrain, stand="elevation"),
    )
    return Shot(settings, shot.run)


def in_process(
    choice: dict[str, str],
    views: list[str],
    access: dict[str, Any],
    uses: list[list[str]],
    keep: bool,
    progress: Progress,
    tell: MessageCallback,
    preview: bool = False,
) -> None:
    """Prepare; worker side."""
    source, how = ShotSource(**choice), from_plain(access)
    wanted = [(use, what) for use, what in uses]
    shot = source.shot()
    if preview:
        make(coarse(shot), progress, how, wanted)
        return
    if shot.settings.terrain.stand == "tiles":
        terrain = replace(shot.settings.terrain, stand="elevation")
        first = Shot(replace(shot.settings, terrain=terrain), shot.run)
        heights = tile_heights.location(shot.settings, shot.run)
        if not (_kept(first, keep) and heights.exists()):
            make(first, progress, how, wanted)
            found = tile_cut.location(first).with_suffix(tile_cut.HEIGHTS)
            if found.is_file():
                shutil.copyfile(found, heights)
        shot = source.shot()
    for built in [for_view(shot, view) for view in views] or [shot]:
        if not _kept(built, keep):
            for sentence in make(built, progress, how, wanted):
                tell(sentence)


def _kept(shot: Shot, keep: bool) -> bool:
    """Whether a shot's choice stays as it is; files of this machine may have changed, and are read again."""
    try:
        cut = tile_cut.prepared(shot) if keep else None
    except InputError:  # damaged: it is made again
        return False
    places = shot.settings.tiles.sources
    remote = all("://" in place and policies.of_place(place).may_work_offline for place in places)
    if not remote or cut is None or not cut.is_whole():
        return False
    os.utime(tile_cut.location(shot))  # when it was used last
    return True


def make(
    shot: Shot, progress: Progress = silent, access: TileAccess | None = None, uses: Sequence[Use] = ()
) -> list[str]:
    """Write the cut of a shot.

    Returns
    -------
    What the user should know.

    Raises
    ------
    Error
        A tile is missing, and `access` is strict.
    InputError
        A policy forbids the uses, or pictures are too small for the credits.
    """
    settings, path, access = shot.settings.tiles, tile_cut.location(shot), access or TileAccess()
    path.parent.mkdir(parents=True, exist_ok=True)
    undulation, matrix = to_scene(shot)
    prepared = [
        _Source(shot, number, path.parent, matrix, access, uses).prepared(
            share(progress, number, len(settings.sources), "tiles")
        )
        for number in range(len(settings.sources))
    ]
    names = tuple(name for each in prepared for name in each.names)
    heights = _heights(shot, path, names)
    notices = Counter(part for each in prepared for part in each.credits)
    cut = TileCut(
        path.parent,
        path.stem,
        names,
        tuple(notice for notice, _ in notices.most_common()),
        tuple(sorted(reason for each in prepared for reason in each.missing)),
        max(each.choice.error for each in prepared),
        tuple(dict.fromkeys(each.policy.logo for each in prepared if each.policy.logo)),
        sum(each.empty for each in prepared),
        tile_difference.measure(heights, shot.settings, shot.run) if heights else None,
        sum(each.choice.bytes for each in prepared),
        sum(each.triangles for each in prepared),
    )
    picture_credits.check_room(shot, picture_credits.of_cuts(shot.settings, [cut]))
    if access.strict and cut.missing:
        raise Error(f"--strict: {count(len(cut.missing), 'tile')} missing: {'; '.join(cut.missing)}")
    tile_cut.write(cut, path)
    told = [tile_difference.sentence(cut.difference, undulation)] if heights else []
    return [*_told(cut, prepared), *told]


def open_place(shot: Shot, number: int, access: TileAccess) -> Source:
    """Open a source of a scene.

    Raises
    ------
    InputError
        It is not there, or not allowed.
    """
    from ..tiles.sources import open_source

    place = shot.settings.tiles.sources[number]
    near = shot.settings.path.parent / place
    return open_source(str(near) if near.exists() else place, access.network())


def to_scene(shot: Shot) -> tuple[float | None, NDArray[np.float64]]:
    """The geoid's height at a scene, m, and the matrix (4, 4) from Earth-centred metres.

    The height is None for a run of heights above the ellipsoid, which needs none.

    Raises
    ------
    InputError
        It is not known.
    """
    from ..tiles import geoid
    from ..tiles.place import ecef_to_frame

    settings, frame = shot.settings, shot.local_frame
    if shot.run.vertical != "orthometric":
        return None, ecef_to_frame(frame)
    if settings.tiles.geoid is not None:
        return settings.tiles.geoid, ecef_to_frame(frame, settings.tiles.geoid)
    found = geoid.find()
    if found is None:
        raise input_error(settings.path, 0, 0, f"tiles.geoid is left out, and {geoid.REMEDY}")
    height, *slope = found.plane(frame)
    return height, ecef_to_frame(frame, height, (slope[0], slope[1]))


def _heights(shot: Shot, path: Path, names: Sequence[str]) -> TileHeights | None:
    """Write heights of a cut's tiles beside it; None without tiles."""
    if not names:
        path.with_suffix(tile_cut.HEIGHTS).unlink(missing_ok=True)
        return None
    found = (decoded.read(path.parent / name) for name in names)
    surface = tile_heights.rasterise(found, shot.bare_ground.up, land_use.buildings(shot))
    tile_heights.write(path.with_suffix(tile_cut.HEIGHTS), surface)
    return TileHeights(shot.ground.frame, surface)


def _told(cut: TileCut, prepared: Sequence[_Prepared]) -> Iterator[str]:
    """What the user should know of a cut."""
    if cut.words:
        yield f"credits of tiles, which pictures show: {cut.words.text()}"
    for each in prepared:
        if each.advised:
            yield (
                f"{each.policy.name} recommends tiles to {each.choice.asked:g} pixels; "
                "tiles.error sets another value"
            )
        if sentence := each.choice.sentence():
            yield sentence
    if more := cut.missing[1:_NAMED]:
        yield f"also missing: {'; '.join(more)}" + (" ..." if len(cut.missing) > _NAMED else "")
    if cut.empty:
        yield f"empty, without triangles between finite vertices: {count(cut.empty, 'tile')}"


@dataclass(frozen=True)
class _Prepared:
    """A source's share of a cut.

    Attributes
    ----------
    names
        Of decoded tiles.
    credits
        A credit for each tile.
    missing
        What cannot be had, and why.
    empty
        Tiles without triangles.
    triangles
        Of all of them.
    advised
        The error is the policy's.
    """

    choice: Choice
    names: list[str]
    credits: list[str]
    missing: list[str]
    empty: int
    triangles: int
    policy: Policy
    advised: bool


class _Source:
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
        from ..tiles.cut import Budget, Views, pixels
        from ..tiles.loader import Loader

        self.settings, self.folder = shot.settings.tiles, folder
        source = open_place(shot, number, access)
        self.policy = source.policy
        tile_terms.check_source(shot.settings, number, self.policy, uses)
        self.advised = self.policy.pixel_error > 0.0 and self.settings.error == TileSettings().error
        self.error = self.policy.pixel_error if self.advised else self.settings.error
        self.loader: Loader = Loader(source)
        self.matrix = matrix
        view_set, heights, halves, eyes = shot.visibility.all_views()
        earth = self.matrix if all(view.perspective for view in shot.paths) else None
        self.views = Views(view_set, pixels(heights, halves), eyes, earth)
        megabytes = self.settings.max_size * 1_000_000
        self.budget = Budget(self.settings.max_tiles, megabytes, self.settings.max_triangles)
        self.files: dict[int, str] = {}
        self._decoded: dict[str, Summary | None] = {}

    def prepared(self, progress: Progress) -> _Prepared:
        """Choose, fetch and decode until everything that is chosen can be shown."""
        from ..tiles.cut import choose

        triangles: dict[int, int] = {}
        for _ in range(_TRIES):
            choice = choose(
                self.loader,
                self.views,
                self.matrix,
                self.error,
                self.budget,
                shadows=True,
                put=self._put,
                triangles=triangles,
            )
            wanted, bad = self._contents(choice.contents.tolist())
            failed = decode_tiles.run(list(wanted.values()), progress)
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
        return _Prepared(
            choice,
            [Path(out).name for out in there],
            list(self._credits(there.values())),
            sorted(self.loader.tree.broken.values()),
            sum(not (about.triangles or about.points) for about in there.values()),
            sum(about.triangles for about in there.values()),
            self.policy,
            self.advised,
        )

    def _contents(self, numbers: list[int]) -> tuple[dict[int, Content], dict[int, str]]:
        """What is to be decoded, and why the rest cannot be: files beside it are missing, or it is wrong."""
        wanted, bad = dict[int, Content](), dict[int, str]()
        for number in numbers:
            try:
                wanted[number] = self._content(number)
            except (MissingError, _WrongError) as error:
                bad[number] = str(error)
        return wanted, bad

    def _put(self, content: int, data: bytes) -> None:
        """Keep a content under a name that follows it."""
        self.files[content] = self._stored(data)

    def _stored(self, data: bytes) -> str:
        path = self.folder / "content" / hashlib.sha256(data).hexdigest()
        files.keep(path, data)
        return str(path)

    def _content(self, content: int) -> Content:
        """What is to be decoded of a content."""
        tree = self.loader.tree
        tile, document = int(tree.content[content, 0]), tree.documents[int(tree.content[content, 1])]
        earth = tree.matrix_of(tile)
        matrix, path = self.matrix @ earth, self.files[content]
        key = hashlib.sha256(Path(path).name.encode() + _plain(matrix) + document.up_axis.encode())
        uri = self.loader.content_uri(content)
        return Content(
            file=path,
            name=self.loader.source.name(uri),
            matrix=matrix.tolist(),
            earth_matrix=earth.tolist(),
            out=str(self.folder / f"{key.hexdigest()[:32]}{decoded.END}"),
            up_axis=document.up_axis,
            beside=self._beside(uri, path),
        )

    def _beside(self, uri: str, path: str) -> dict[str, str]:
        """Files beside a content that it needs, by their uri."""
        source, name = self.loader.source, self.loader.source.name(uri)
        data, found = Path(path).read_bytes(), dict[str, bytes]()
        while wanted := [each for each in _needed(data, name, found) if each not in found]:
            found |= {each: source.read(source.resolve(uri, each)) for each in wanted}
        return {each: self._stored(content) for each, content in found.items()}

    def _summary(self, content: Content) -> Summary | None:
        """Numbers of a decoded content, read once; None where it could not be decoded, or is damaged."""
        if self._decoded.get(content.out) is None:
            self._decoded[content.out] = decoded.summary(Path(content.out))
        return self._decoded[content.out]

    def _credits(self, shown: Iterable[Summary]) -> Iterator[str]:
        """A notice for each tile that has one, its document's own after it."""
        notices = [about.credit for about in shown]
        notices += [document.copyright for document in self.loader.tree.documents]
        for notice in notices:
            yield from filter(None, map(str.strip, notice.split(";")))


class _WrongError(Exception):
    """A content that cannot be read, and is named as a tile that is missing."""


def _needed(data: bytes, name: str, found: dict[str, bytes]) -> list[str]:
    """Files beside a content that it names.

    Raises
    ------
    _WrongError
        It cannot be read.
    """
    from firetwin_core import tiles

    try:
        return tiles.resources_needed(data, name, found)
    except (InputError, ValueError) as error:
        raise _WrongError(str(error)) from None


def _plain(matrix: NDArray[np.float64]) -> bytes:
    """A matrix to a tenth of a millimetre at 60 km, so that rounding does not make another tile of it."""
    return np.round(matrix, 9).tobytes()
