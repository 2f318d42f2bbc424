"""Zarr stores of format 2 and 3, as folders or ZIP archives, read like netCDF files.

Only arrays at the root are read. Formats encode missing values differently: in format 3 they are the
attribute `_FillValue`; in format 2 they are the array's `fill_value`, except 0, zarr's default and a value of
masks. Absent chunks hold the fill value, as zarr omits empty ones. Unknown codecs are refused: pickle can run
code.
"""

from __future__ import annotations

import base64
import sys
import warnings
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import unpacking
from . import netcdf, optional_packages

_ROOT = (".zgroup", "zarr.json", ".zmetadata")
_ARRAYS = 1000  # arrays of a store at most
_CHUNK = 1 << 30  # bytes of a chunk at most
_WAYS = 10  # chunks that are read concurrently
_METADATA = 1 << 28  # bytes of all metadata
_KEPT = 1 << 28  # bytes of decoded times of a chunk in the cache
_CODECS = frozenset(
    (
        "adler32",
        "bitround",
        "blosc",
        "bytes",
        "bz2",
        "crc32",
        "crc32c",
        "delta",
        "endian",
        "fixedscaleoffset",
        "fletcher32",
        "gzip",
        "lz4",
        "lzma",
        "packbits",
        "quantize",
        "sharding_indexed",
        "shuffle",
        "transpose",
        "zlib",
        "zstd",
    )
)


def is_store(path: Path) -> bool:
    """Check whether a folder or a ZIP archive has the metadata of a zarr group."""
    if path.is_dir():
        return any((path / name).is_file() for name in _ROOT)
    return path.suffix.lower() == ".zip" and unpacking.has_member(path, _ROOT)


class ZarrFile(netcdf.File):
    """An open zarr store. Scale, offset and missing values are applied.

    Raises
    ------
    InputError
        The store cannot be read, or its arrays are too many, too large or coded in an unknown way.
    """

    kind = "zarr store"

    def __init__(self, path: Path) -> None:
        self.path = path
        library = optional_packages.package("zarr")
        self._cached: set[str] = set()
        self.dimensions = {}
        with self.sense(), unpacking.allowing(_METADATA), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about names that are not part of the format
            storage = library.storage
            store = (
                storage.LocalStore(path, read_only=True)
                if path.is_dir()
                else storage.ZipStore(path, mode="r")
            )
            self._store = store
            group = library.open_group(store, mode="r")
            self.data = _Attributes(dict(group.attrs))
            arrays = dict(islice(group.arrays(), _ARRAYS + 1))
            if len(arrays) > _ARRAYS:
                raise self.error(f"has more than {_ARRAYS} arrays; copy the needed ones to a new store")
            self.variables = {name: _Variable(array) for name, array in arrays.items()}

    def read(self, name: str, *index: int | slice) -> NDArray:
        """Read a part of a variable."""
        if name in self.variables:
            array = self.variables[name].array
            if unknown := sorted(set(_codecs(array.metadata.to_dict())) - _CODECS):
                raise self.error(f"{name} has the codec {unknown[0]}, which is not read; use zstd or blosc")
            size = int(np.prod(array.chunks, dtype=np.float64)) * array.dtype.itemsize
            if size > _CHUNK:
                raise self.error(f"{name} has chunks of {size / 1e6:,.0f} MB; write chunks below 1,000 MB")
            ways = min(_WAYS, max(1, _KEPT // max(size, 1)))
            with optional_packages.package("zarr").config.set({"async.concurrency": ways}):
                return super().read(name, *index)
        return super().read(name, *index)

    def _room(self, variable: Any, size: int) -> int:
        """Return the memory for reading `size` bytes, with chunks that are unpacked concurrently."""
        array = variable.array
        chunk = int(np.prod(array.chunks, dtype=np.float64)) * array.dtype.itemsize
        return super()._room(variable, size) + 2 * max(chunk, _KEPT)

    def close(self) -> None:
        """Close the store."""
        self._store.close()


def written(path: Path, names: list[str]) -> int:
    """Count the times of a store up to the last one of which any of these arrays has a chunk.

    Metadata of zarr gets the number of times before the chunks are written.
    """
    if not path.is_dir():
        return sys.maxsize  # a ZIP archive is written at once
    store = ZarrFile(path)
    try:
        counts = [0]
        for name in names:
            array = store.variables[name].array
            long = (getattr(array, "shards", None) or array.chunks)[0]
            counts += [(_time_of_chunk(each, path / name) + 1) * long for each in _chunk_files(path / name)]
        return max(counts)
    finally:
        store.close()


def _chunk_files(folder: Path) -> Iterator[Path]:
    return (each for each in folder.rglob("*") if each.is_file() and each.name[-1].isdigit())


def _time_of_chunk(file: Path, folder: Path) -> int:
    """Return the first index in the name of a chunk: ``12.0.0``, ``12/0/0``, ``c/12/0/0`` or ``c.12.0.0``."""
    parts = file.relative_to(folder).as_posix().replace(".", "/").split("/")
    number = parts[1] if parts[0] == "c" and len(parts) > 1 else parts[0]
    return int(number) if number.isdigit() else -1


class _Attributes:
    """Attributes with the methods of netCDF4."""

    def __init__(self, attributes: dict[str, Any]) -> None:
        self._attributes = attributes

    def ncattrs(self) -> list[str]:
        """List the names."""
        return list(self._attributes)

    def getncattr(self, name: str) -> Any:
        """Return a value."""
        return self._attributes[name]


class _Variable(_Attributes):
    """An array with the methods of a variable of netCDF4 that `netcdf` uses."""

    def __init__(self, array: Any) -> None:
        self.array, self.shape, self.dtype = array, array.shape, array.dtype
        self._block: tuple[int, NDArray] | None = None  # first index and values of the last chunk of times
        super().__init__(_missing(array, dict(array.attrs)))

    def chunking(self) -> str:
        """Tell that netCDF's cache of chunks does not apply."""
        return "contiguous"

    def __getitem__(self, index: Any) -> NDArray:
        """Read a part; times of one chunk are decoded together."""
        first, *rest = index if isinstance(index, tuple) else (index,)
        long = self.array.chunks[0] if self.shape else 1
        size = long * int(np.prod(self.shape[1:], dtype=np.float64)) * self.dtype.itemsize
        if not isinstance(first, int) or long < 2 or len(self.shape) < 3 or size > _KEPT:
            return np.asarray(self.array[index])
        begin = first % self.shape[0] // long * long
        if self._block is None or self._block[0] != begin:
            self._block = begin, np.asarray(self.array[begin : begin + long])
        return self._block[1][(first % self.shape[0] - begin, *rest)]


def _missing(array: Any, attributes: dict[str, Any]) -> dict[str, Any]:
    """Add the missing value of format 2; decode it in format 3, where xarray writes base64."""
    value = attributes.get("_FillValue")
    if isinstance(value, str):
        attributes["_FillValue"] = np.frombuffer(base64.b64decode(value), "<f8")[0]
    elif value is None and array.metadata.zarr_format == 2 and array.fill_value not in (None, 0):
        attributes["_FillValue"] = array.fill_value
    return attributes


def _codecs(metadata: Any) -> Iterator[str]:
    """List the names of the codecs, also those within shards, of an array's metadata."""
    stack = [metadata.get(key) for key in ("codecs", "filters", "compressor")]
    while stack:
        node = stack.pop()
        if isinstance(node, dict):
            if isinstance(name := node.get("id") or node.get("name"), str):
                yield name.removeprefix("numcodecs.")
            stack += node.values()
        elif isinstance(node, (list, tuple)):
            stack += node
