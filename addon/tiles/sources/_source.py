"""Interface of sources of tiles, and limits on file sizes and decompression."""

from __future__ import annotations

import zlib
from abc import ABC, abstractmethod
from os import PathLike

from ... import limits
from ...errors import InputError, input_error
from ..policies import OPEN, Policy

MAX_BYTES = limits.TILE_BYTES  # of one file
GROWTH = limits.TILE_GROWTH  # maximum ratio of decompressed to compressed size
_FREE = 1 << 20  # bytes; smaller results may exceed the ratio
_GZIP = b"\x1f\x8b"


class MissingError(InputError):
    """A file that does not exist or is unavailable: an ancestor is shown in place of the tile."""


def missing(path: str | PathLike[str], reason: str) -> MissingError:
    """Make a MissingError in the format of `input_error`."""
    error = MissingError(f"{path}: {reason}")
    error.path, error.line, error.column, error.reason = str(path), 0, 0, reason
    return error


class Source(ABC):
    """Files of a tileset.

    Attributes
    ----------
    root
        URI of its tileset.json.
    parallel
        Number of concurrent reads.
    local
        Files are on this machine, so reading all of them is cheap.
    """

    root: str
    parallel = 1
    local = True
    policy: Policy = OPEN

    @abstractmethod
    def resolve(self, base: str, reference: str) -> str:
        """Resolve a reference of a file to a URI.

        Parameters
        ----------
        base
            URI of the referring file.
        reference
            Reference as written in the file.

        Raises
        ------
        InputError
            The reference leaves the source.
        """

    @abstractmethod
    def read(self, uri: str, max_bytes: int = MAX_BYTES) -> bytes:
        """Read a file and decompress it.

        Raises
        ------
        MissingError
            The file does not exist or is unavailable.
        InputError
            The file exceeds `max_bytes` bytes, or the source stopped answering.
        """

    def size(self, uri: str) -> int | None:
        """Return the bytes of a file if known without reading it."""
        return None

    def name(self, uri: str) -> str:
        """Return a URI for messages, without secrets."""
        return uri

    def close(self) -> None:  # noqa: B027 (a folder has nothing to close)
        """Close files and connections."""


def unpack(data: bytes, max_bytes: int, name: str) -> bytes:
    """Decompress gzip data; return other data unchanged.

    Raises
    ------
    MissingError
        The data are damaged or end early.
    InputError
        The result exceeds `max_bytes` bytes, or 64 times the compressed size.
    """
    return gunzip(data, max_bytes, name) if data[:2] == _GZIP else data


def gunzip(data: bytes, max_bytes: int, name: str, bits: int = 31) -> bytes:
    """Decompress within the limits; `bits` is zlib's `wbits`: 31 gzip, 15 zlib, -15 raw."""
    limit = min(max_bytes, max(GROWTH * len(data), _FREE))
    engine = zlib.decompressobj(bits)
    try:
        result = engine.decompress(data, limit + 1)
    except zlib.error as error:
        raise missing(name, f"is damaged: {error}") from error
    if len(result) > limit:
        raise input_error(name, f"grows to more than {limit:,} bytes when decompressed")
    if not engine.eof:
        raise missing(name, "ends early: its compressed data are not complete")
    return result


def check_size(size: int, max_bytes: int, name: str) -> None:
    """Raise InputError for a file of more than `max_bytes` bytes."""
    if size > max_bytes:
        raise input_error(name, f"has {size:,} bytes; at most {max_bytes:,} are read")
