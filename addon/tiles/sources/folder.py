"""Tilesets in a folder."""

from __future__ import annotations

from pathlib import Path

from ...errors import input_error
from ._source import MAX_BYTES, Source, check_size, missing, unpack
from .local import LeavesError, relative

_REMEDY = "--tile-root DIR, or root under [tiles], allows a folder above"


class Folder(Source):
    """A tileset.json and the files in its folder and below.

    Parameters
    ----------
    path
        The file, or its folder.
    within
        Folder above it within which its files may refer to one another (``../tiles/a.glb``); ignored unless
        it contains the file.

    Raises
    ------
    InputError
        The file does not exist.
    """

    def __init__(self, path: Path, within: Path | None = None) -> None:
        file = path / "tileset.json" if path.is_dir() else path
        if not file.is_file():
            raise input_error(file, "is not there; name a tileset.json, its folder, a .3tz file or a URL")
        above = within.resolve() if within else None
        if above is not None and file.resolve().is_relative_to(above):
            self.folder, self.root = above, file.resolve().relative_to(above).as_posix()
        else:
            self.folder, self.root = file.parent.resolve(), file.name

    def resolve(self, base: str, reference: str) -> str:
        """Resolve to a path below the folder."""
        try:
            return relative(base, reference, self.name(base))
        except LeavesError as error:
            raise input_error(error.path, f"{error.reason}; {_REMEDY}") from None

    def read(self, uri: str, max_bytes: int = MAX_BYTES) -> bytes:
        """Read a file in the folder; links are followed."""
        path = self._path(uri)
        try:
            check_size(path.stat().st_size, max_bytes, self.name(uri))
            with path.open("rb") as file:
                data = file.read(max_bytes + 1)
        except OSError as error:
            raise missing(self.name(uri), f"cannot be read ({error.strerror})") from error
        check_size(len(data), max_bytes, self.name(uri))
        return unpack(data, max_bytes, self.name(uri))

    def size(self, uri: str) -> int | None:
        """Return the file size."""
        try:
            return self._path(uri).stat().st_size
        except OSError:
            return None

    def name(self, uri: str) -> str:
        """Return the path of the file."""
        return str(self.folder / uri)

    def _path(self, uri: str) -> Path:
        path = (self.folder / uri).resolve()
        if not path.is_relative_to(self.folder):
            reason = f"is a link that leaves the tileset's folder; {_REMEDY}"
            raise input_error(self.name(uri), reason)
        if path.exists() and not path.is_file():
            raise missing(self.name(uri), "is not a file")
        return path
