"""What every source of tiles does, and limits of what it reads."""

from __future__ import annotations

import zlib
from abc import ABC, abstractmethod
from os import PathLike

from ...errors import InputError, input_error
from ..policies import OPEN, Policy

MAX_BYTES = 256 << 20  # of one file
GROWTH = 64  # most that something compressed may grow
_FREE = 1 << 20  # bytes to which anything may grow
_GZIP = b"\x1f\x8b"


class MissingError(InputError):
    """A file that is not there, or cannot be had now: an ancestor stands in for the tile."""


def missing(path: str | PathLike[str], reason: str) -> MissingError:
    """MissingError in the format of `input_error`."""
    error = MissingError(f"{path}: {reason}")
    error.path, error.line, error.column, error.reason = str(path), 0, 0, reason
    return error


class Source(ABC):
    """A tileset's files.

    Attributes
    ----------
    root
        URI of its tileset.json.
    parallel
        How many files are best read at once.
    local
        Files are of this machine, so that all may be looked at.
    """

    root: str
    parallel = 1
    local = True
    policy: Policy = OPEN

    @abstractmethod
    def resolve(self, base: str, reference: str) -> str:
        """URI of what a file refers to.

        Parameters
        ----------
        base
            URI of the file.
        reference
            As the file has it.

        Raises
        ------
        InputError
            It leads out of the source.
        """

    @abstractmethod
    def read(self, uri: str, max_bytes: int = MAX_BYTES) -> bytes:
        """Content of a file, unpacked.

        Raises
        ------
        MissingError
            It is not there, or cannot be had now.
        InputError
            It is larger than `max_bytes` bytes, or the source does not go on.
        """

    def size(self, uri: str) -> int | None:
        """Bytes of a file where they are known without reading it."""
        return None

    def name(self, uri: str) -> str:
        """A URI for messages, without secrets."""
        return uri

    def close(self) -> None:  # noqa: B027 (a folder has nothing to close)
        """Let go of files and connections."""


def unpack(data: bytes, max_bytes: int, name: str) -> bytes:
    """Content of a gzip file; other data as they are.

    Raises
    ------
    MissingError
        It is damaged, or ends early.
    InputError
        It would grow beyond `max_bytes` bytes, or more than 64 times.
    """
    return gunzip(data, max_bytes, name) if data[:2] == _GZIP else data


def gunzip(data: bytes, max_bytes: int, name: str, bits: int = 31) -> bytes:
    """Decompress within the limits of growth; `bits` as zlib has them: 31 gzip, 15 zlib, -15 neither."""
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
