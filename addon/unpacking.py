"""Archives and arrays of others, unpacked within `limits.UNPACKED_BYTES`.

Sizes are counted while data are unpacked. `allowing` lets the system count for libraries that unpack by
themselves, such as HDF5 and zarr.
"""

from __future__ import annotations

import contextlib
import zipfile
import zlib
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import IO

import numpy as np
from numpy.lib import format as npy
from numpy.typing import DTypeLike, NDArray

from . import memory
from .errors import InputError, input_error, reading, refuse_odd
from .limits import UNPACKED_BYTES

ERRORS = (OSError, EOFError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error, NotImplementedError)
"""Errors of a damaged ZIP archive."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # Python unpacks other methods in unlimited pieces
_ENCRYPTED = 0x1
_READERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
_ROOM = 1 << 29
"""Memory that a library may take besides its data, bytes."""


def has_member(path: Path, names: Collection[str]) -> bool:
    """Check whether a file is a ZIP archive with one of these members."""
    try:
        refuse_odd(path)
        if not zipfile.is_zipfile(path):
            return False
        with zipfile.ZipFile(path) as archive:
            return not set(names).isdisjoint(archive.namelist())
    except (InputError, *ERRORS):
        return False


def member_fault(member: zipfile.ZipInfo) -> str:
    """Describe why a member cannot be unpacked in pieces; empty if it can."""
    if member.compress_type not in _METHODS:
        return f"is compressed by method {member.compress_type}; pack the archive with deflate, or without"
    return "is encrypted; pack the archive without a password" if member.flag_bits & _ENCRYPTED else ""


def read_member(path: Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo, most: int) -> bytes:
    """Read a member of an archive at `path`.

    Raises
    ------
    InputError
        It has more than `most` bytes, or is compressed or encrypted in another way.
    """
    if fault := member_fault(member):
        raise input_error(path, f"{member.filename[:200]} {fault}")
    with archive.open(member) as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise _too_large(path, member.filename, most)
    return data


def npz_names(path: Path) -> list[str]:
    """List the arrays of an .npz file."""
    with reading(path, "NumPy archive"), zipfile.ZipFile(path) as archive:
        return [name.removesuffix(".npy") for name in archive.namelist()]


def read_npz(
    path: Path, names: Collection[str] | None = None, dtype: DTypeLike = None, most: int = UNPACKED_BYTES
) -> dict[str, NDArray]:
    """Read the arrays of an .npz file.

    Parameters
    ----------
    names
        Arrays to read, as far as they exist; None: all.
    dtype
        Type to which they are converted.
    most
        Limit on the bytes of all of them, as stored and as converted.

    Raises
    ------
    InputError
        The file is damaged, or its arrays are larger.
    """
    arrays: dict[str, NDArray] = {}
    with reading(path, "NumPy archive"), zipfile.ZipFile(path) as archive:
        for member in archive.infolist():
            name = member.filename.removesuffix(".npy")
            if names is not None and name not in names:
                continue
            if fault := member_fault(member):
                raise input_error(path, f"{name[:200]} {fault}")
            with archive.open(member) as file:
                most -= _size(file, dtype)
            if most < 0:
                raise _too_large(path, name, UNPACKED_BYTES)
            with archive.open(member) as file:
                array = npy.read_array(file, allow_pickle=False)
            arrays[name] = array if dtype is None else array.astype(dtype)
    return arrays


def read_npy(path: Path, most: int = UNPACKED_BYTES) -> NDArray:
    """Read an .npy file.

    Raises
    ------
    InputError
        The file is damaged, or has more than `most` bytes.
    """
    with reading(path, "NumPy file"), path.open("rb") as file:
        if _size(file, None) > most:
            raise _too_large(path, "", most)
        file.seek(0)
        return npy.read_array(file, allow_pickle=False)


@contextlib.contextmanager
def allowing(size: int) -> Iterator[None]:
    """Let a library take `size` bytes, and some more, within this block; Linux counts them.

    Raises
    ------
    InputError, MemoryError
        It needs more.
    """
    with memory.limited(size + _ROOM):
        yield


def _size(file: IO[bytes], dtype: DTypeLike) -> int:
    """Return the bytes of the array of an .npy file, as stored and as converted, by its header."""
    version = npy.read_magic(file)
    if version not in _READERS:
        raise ValueError(f"unknown version {version} of its header")
    shape, _, stored = _READERS[version](file)
    itemsize = stored.itemsize + (np.dtype(dtype).itemsize if dtype is not None else 0)
    count = 1
    for length in shape:
        count *= length
    return count * itemsize


def _too_large(path: Path, name: str, most: int) -> InputError:
    part = f"{name[:200]} " if name else ""
    return input_error(path, f"{part}grows beyond {most / 1e6:,.0f} MB when unpacked; take a part of it")
