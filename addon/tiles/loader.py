"""Loader of a tree on demand: external tilesets and subtrees, fetched concurrently."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

from ..errors import InputError, reading
from ..progress import Progress, silent
from . import contents, documents, explicit, implicit
from .explicit import External
from .implicit import Subtree
from .json_text import MAX_BYTES, Node, parse
from .sources import MissingError, Source
from .tree import EXTERNAL, MODEL, Tree

Job = External | Subtree


class Loader:
    """Loader of a source's tileset.

    Attributes
    ----------
    tree
        The part of the tileset that has been read.
    files
        Number of JSON files and subtrees read.

    Raises
    ------
    InputError
        The root cannot be read.
    """

    def __init__(self, source: Source) -> None:
        self.source, self.tree, self.files = source, Tree(), 1
        self._kinds: dict[int, str] = {}
        self._pool: ThreadPoolExecutor | None = None
        with reading(source.name(source.root)):
            node = parse(source.read(source.root, MAX_BYTES), source.name(source.root))
            explicit.read(self.tree, node, source.root, load=self._json(source.root))

    def expand(self, tile_ids: Iterable[int]) -> None:
        """Read the external tilesets and subtrees of these tiles; a tile with a missing file is broken.

        Raises
        ------
        InputError
            A file is there, but cannot be read, or is refused.
        """
        jobs = [(tile, job) for tile in sorted(map(int, tile_ids)) for job in self.tree.jobs.get(tile, [])]
        uris = [self._uri(job) for _, job in jobs]
        found = self._fetch(uris, MAX_BYTES)
        for (tile, job), uri, data in zip(jobs, uris, found, strict=True):
            self.tree.jobs.pop(tile, None)
            if isinstance(data, MissingError):
                self.tree.broken[tile] = str(data)
            else:
                self._graft(tile, job, uri, data)

    def expand_all(self, max_files: int | None = None) -> bool:
        """Read all JSON files and subtrees, or at most `max_files`; return whether all were read."""
        while self.tree.jobs:
            tiles = sorted(self.tree.jobs)
            if max_files is not None:
                tiles = tiles[: max(max_files - self.files, 0)]
            if not tiles:
                return False
            self.expand(tiles)
        return True

    def content_uri(self, content: int) -> str:
        """Resolve the URI of a content for the source."""
        document = self.tree.documents[int(self.tree.content[content, 1])]
        return self.source.resolve(document.uri, self.tree.reference(content))

    def check(
        self,
        content_ids: Iterable[int],
        on_content: Callable[[int, bytes], object] | None = None,
        progress: Progress = silent,
    ) -> bool:
        """Fetch contents and detect their types.

        External tilesets are grafted; a tile with a missing content is broken.

        Parameters
        ----------
        on_content
            Called with the number and bytes of each content that can be shown.

        Returns
        -------
        True if the tree has changed.
        """
        numbers = [number for number in map(int, content_ids) if number not in self._kinds]
        changed = False
        for first in range(0, len(numbers), 64):
            part = numbers[first : first + 64]
            uris = [self.content_uri(number) for number in part]
            for number, uri, data in zip(part, uris, self._fetch(uris), strict=True):
                changed |= self._note(number, uri, data, on_content)
            progress(first + len(part), len(numbers), "fetching tiles")
        return changed

    def kind(self, content: int) -> str:
        """Return the type of a content: from `check`, otherwise by its name."""
        return self._kinds.get(content) or contents.kind_by_name(self.tree.reference(content))

    def _note(
        self,
        content: int,
        uri: str,
        data: bytes | MissingError,
        on_content: Callable[[int, bytes], object] | None,
    ) -> bool:
        tile = int(self.tree.content[content, 0])
        if isinstance(data, MissingError):
            self._kinds[content] = "missing"
            self.tree.broken[tile] = str(data)
            return True
        self._kinds[content] = contents.kind(data)
        if self._kinds[content] == "json":
            self._kinds[content] = "gltf"
            with contextlib.suppress(InputError):  # not JSON, so not a tileset; the decoder reports it
                if documents.is_tileset(node := parse(data, self.source.name(uri))):
                    self._kinds[content] = "tileset"
        if self._kinds[content] == "tileset":
            self.tree.set_kind(content, EXTERNAL)
            self._read(tile, node, uri)
            return True
        if (short := contents.truncation(data)) is not None:
            self._kinds[content] = "missing"
            self.tree.broken[tile] = f"{self.source.name(uri)}: ends early: {short}"
            return True
        if on_content is not None:
            on_content(content, data)
        return False

    def _uri(self, job: Job) -> str:
        if isinstance(job, External):
            return self.content_uri(job.content)
        return self.source.resolve(job.place.document.uri, job.reference)

    def _graft(self, tile: int, job: Job, uri: str, data: bytes) -> None:
        name = self.source.name(uri)
        if isinstance(job, Subtree):
            self.files += 1
            with reading(name):
                implicit.expand(self.tree, job, tile, data, name, self._bytes(uri))
        elif documents.is_tileset(node := parse(data, name)):
            self._kinds[job.content] = "tileset"
            self._read(tile, node, uri)
        else:
            self.tree.set_kind(job.content, MODEL)  # such as a glTF with a name that ends in .json

    def _read(self, holder: int, node: Node, uri: str) -> None:
        self.files += 1
        with reading(self.source.name(uri)):
            explicit.read(self.tree, node, uri, holder, self._json(uri))

    def _fetch(self, uris: list[str], max_bytes: int | None = None) -> list[bytes | MissingError]:
        """Read files; an error in place of each missing one."""

        def one(uri: str) -> bytes | MissingError:
            try:
                return self.source.read(uri) if max_bytes is None else self.source.read(uri, max_bytes)
            except MissingError as error:
                return error

        if self.source.parallel == 1 or len(uris) < 2:
            return [one(uri) for uri in uris]
        if self._pool is None:  # reused: each of its threads has the cache open
            self._pool = ThreadPoolExecutor(self.source.parallel)
        return list(self._pool.map(one, uris))

    def _bytes(self, base: str) -> Callable[[str], bytes]:
        return lambda reference: self.source.read(self.source.resolve(base, reference), MAX_BYTES)

    def _json(self, base: str) -> Callable[[str], Node | None]:
        def load(reference: str) -> Node | None:
            uri = self.source.resolve(base, reference)
            try:
                return parse(self.source.read(uri, MAX_BYTES), self.source.name(uri))
            except MissingError:
                return None

        return load
