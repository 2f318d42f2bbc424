"""Tilesets in a .3tz archive: a zip file with a tileset.json."""

from __future__ import annotations

import posixpath
import threading
import zipfile
from pathlib import Path

from ... import limits, unpacking
from ...errors import InputError, input_error
from ._source import GROWTH, MAX_BYTES, Source, check_size, missing, unpack
from .local import relative

_MOST_MEMBERS = limits.TILE_MEMBERS
_FREE = 1 << 20  # bytes; smaller members may exceed the ratio


class Archive(Source):
    """A .3tz file, read by one thread at a time.

    Raises
    ------
    InputError
        The archive is invalid, or a member's name leaves it.
    """

    root = "tileset.json"

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._zip = zipfile.ZipFile(path)
        except (OSError, zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise input_error(path, f"cannot be opened as a .3tz archive: {error}") from error
        self._lock = threading.Lock()
        try:
            self._members = self._checked()
        except InputError:
            self._zip.close()
            raise

    def resolve(self, base: str, reference: str) -> str:
        """Resolve to the name of a member."""
        return relative(base, reference, self.name(base))

    def read(self, uri: str, max_bytes: int = MAX_BYTES) -> bytes:
        """Read a member; its length and CRC are checked."""
        name, member = self.name(uri), self._members.get(uri)
        if member is None:
            raise missing(name, "is not in the archive")
        check_size(member.file_size, max_bytes, name)
        if member.file_size > max(GROWTH * member.compress_size, _FREE):
            raise input_error(name, f"grows more than {GROWTH} times when decompressed")
        if fault := unpacking.member_fault(member):
            raise input_error(name, fault)
        try:
            with self._lock, self._zip.open(member) as file:
                data = file.read(member.file_size + 1)
        except unpacking.ERRORS as error:
            raise missing(name, f"is damaged: {error}") from error
        if len(data) != member.file_size:
            raise missing(name, f"has {len(data):,} bytes, not {member.file_size:,} as the archive says")
        return unpack(data, max_bytes, name)

    def size(self, uri: str) -> int | None:
        """Return the compressed size."""
        member = self._members.get(uri)
        return None if member is None else member.compress_size

    def name(self, uri: str) -> str:
        """Return the paths of archive and member."""
        return f"{self.path}/{uri}"

    def close(self) -> None:
        """Close the file."""
        self._zip.close()

    def _checked(self) -> dict[str, zipfile.ZipInfo]:
        members = self._zip.infolist()
        if len(members) > _MOST_MEMBERS:
            raise input_error(self.path, f"has more than {_MOST_MEMBERS:,} members")
        infos: dict[str, zipfile.ZipInfo] = {}
        for member in members:
            name = member.filename
            if name and member.is_dir():
                continue
            plain = (
                name
                and not name.startswith("/")
                and posixpath.normpath(name) == name
                and not name.startswith("..")
            )
            # orig_filename: zipfile itself cuts names at a NUL and turns the system's separators.
            if not plain or any(c in member.orig_filename for c in "\\:\0"):
                raise input_error(self.path, f"the member {member.orig_filename[:200]!r} leaves the archive")
            if name in infos:
                raise input_error(self.path, f"the member {name[:200]!r} is there twice")
            infos[name] = member
        return infos
