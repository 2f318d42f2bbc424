"""netCDF input in parts; each error is one line that names the file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import unpacking
from ...errors import InputError, input_error, reading, refuse_odd
from . import hdf5_links, heartbeat, netcdf3_length, optional_packages

_MAGIC = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
_OPEN = 8  # open files at most
_LARGEST = 1 << 31  # bytes of one read at most
_CACHE = 1 << 28  # bytes of cached unpacked chunks
_COPIES = 3  # of the read values
UNWRITTEN = 9.9e35
"""Lower limit of netCDF's default fill values of floats, 9.97e36: values that are not written yet."""


def is_netcdf(path: Path) -> bool:
    """Check whether a file begins with netCDF's signature."""
    try:
        refuse_odd(path)
        with path.open("rb") as file:
            return file.read(8).startswith(_MAGIC)
    except OSError:
        return False


def names(path: Path) -> tuple[set[str], set[str]]:
    """List the names of a file's dimensions and variables; empty if it is not a readable netCDF file."""
    if not is_netcdf(path):
        return set(), set()
    data = File(path)
    try:
        return set(data.dimensions), set(data.variables)
    finally:
        data.close()


class File:
    """An open netCDF file. Scale, offset and missing values are applied.

    Raises
    ------
    InputError
        The file cannot be read.
    """

    kind = "netCDF file"

    def __init__(self, path: Path) -> None:
        self.path = path
        library = optional_packages.package("netCDF4")
        with self.sense():
            hdf5_links.refuse(path, library)
            self.data = library.Dataset(str(path))
            self.data.set_auto_maskandscale(False)
            self.variables: dict[str, Any] = dict(self.data.variables)
            self._cached: set[str] = set()
            self.dimensions = {name: len(each) for name, each in self.data.dimensions.items()}
            if self.data.disk_format == "NETCDF3":
                size, need = path.stat().st_size, netcdf3_length.needed(path)
                if size < need:
                    raise self.error(f"has {size} bytes where its header says {need}; it is incomplete")

    @contextmanager
    def sense(self) -> Iterator[None]:
        """Send a heartbeat, and convert library errors to errors that name the file."""
        heartbeat.sign()
        with reading(self.path, self.kind):
            yield

    def error(self, reason: str) -> InputError:
        """Create an error about this file."""
        return input_error(self.path, reason)

    def __contains__(self, name: str) -> bool:
        return name in self.variables

    def shape(self, name: str) -> tuple[int, ...]:
        """Return the shape of a variable.

        Raises
        ------
        InputError
            There is no such variable.
        """
        if name not in self.variables:
            raise self.error(f"has no variable {name}, which is needed")
        return tuple(self.variables[name].shape)

    def read(self, name: str, *index: int | slice) -> NDArray:
        """Read a part of a variable.

        Raises
        ------
        InputError
            There is no such variable, it has other dimensions, or it cannot be read.
        """
        shape = self.shape(name)
        with self.sense():
            variable = self.variables[name]
            if not np.issubdtype(variable.dtype, np.number):
                raise self.error(f"{name} holds no numbers")
            size = variable.dtype.itemsize
            for length, side in zip(shape, (*index, *[slice(None)] * (len(shape) - len(index))), strict=True):
                size *= len(range(length)[side]) if isinstance(side, slice) else 1
            if size > _LARGEST:
                raise self.error(f"{name} has {shape}, more at a time than any model writes")
            if name not in self._cached:
                self._cached.add(name)
                _keep_chunks(variable)
            with unpacking.allowing(self._room(variable, size)):
                values = np.asarray(variable[index if index else Ellipsis])
            return _decoded(variable, values)

    def _room(self, variable: Any, size: int) -> int:
        """Return the memory for reading `size` bytes of a variable, with chunks of HDF5."""
        chunks = variable.chunking()
        chunk = np.prod(chunks, dtype=np.float64) if isinstance(chunks, list) else 0.0
        return _COPIES * size + _CACHE + 4 * int(min(chunk * variable.dtype.itemsize, _LARGEST))

    def attribute(self, name: str, variable: str = "", otherwise: Any = None) -> Any:
        """Read an attribute of the file or of one of its variables."""
        with self.sense():
            owner = self.variables[variable] if variable else self.data
            return owner.getncattr(name) if name in owner.ncattrs() else otherwise

    def close(self) -> None:
        """Close the file."""
        self.data.close()


def _keep_chunks(variable: Any) -> None:
    """Cache all chunks of a time if a chunk has several times, so that each is unpacked once."""
    chunks = variable.chunking()
    if not isinstance(chunks, list) or len(chunks) < 3 or chunks[0] < 2:
        return
    counts = [-(-length // chunk) for length, chunk in zip(variable.shape[1:], chunks[1:], strict=True)]
    need = (
        int(np.prod(counts, dtype=np.float64) * np.prod(chunks, dtype=np.float64)) * variable.dtype.itemsize
    )
    if need <= _CACHE:
        variable.set_var_chunk_cache(size=need + (1 << 20), nelems=10 * int(np.prod(counts)) + 1)


class Files:
    """Pool of files, few of which are open."""

    def __init__(self, opener: Callable[[Path], File] = File) -> None:
        self.kept: dict[Path, File] = {}
        self.opener = opener

    def __call__(self, path: Path) -> File:
        if path not in self.kept:
            if len(self.kept) >= _OPEN:
                self.kept.pop(next(iter(self.kept))).close()
            self.kept[path] = self.opener(path)
        return self.kept[path]

    def close(self) -> None:
        """Close all files."""
        while self.kept:
            self.kept.popitem()[1].close()


def _decoded(variable: Any, values: NDArray) -> NDArray:
    """Apply scale, offset and missing values (CF conventions 1.11, 2.5.1, 8.1)."""
    attributes = set(variable.ncattrs())
    missing = [variable.getncattr(name) for name in ("_FillValue", "missing_value") if name in attributes]
    gone = None
    for value in missing:
        same = np.isin(values, np.atleast_1d(value))
        gone = same if gone is None else gone | same
    if attributes & {"scale_factor", "add_offset"}:
        scale = variable.getncattr("scale_factor") if "scale_factor" in attributes else 1.0
        offset = variable.getncattr("add_offset") if "add_offset" in attributes else 0.0
        values = values * np.float64(scale) + np.float64(offset)
    if gone is not None and gone.any():
        values = values.astype(np.result_type(values, np.float32))
        values[gone] = np.nan
    return values
