"""Parts of other files that an HDF5 file refers to: external links, external raw data, and virtual data sets.

HDF5 reads them unasked, and they may be any file of the user. The check calls the HDF5 library of netCDF4,
which has no function for it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from ...errors import input_error

_HARD, _EXTERNAL = 0, 64  # H5L_type_t
_DATASET = 5  # H5I_type_t
_VIRTUAL = 3  # H5D_layout_t
_BY_NAME, _NATIVE, _DEFAULT = 0, 2, 0
_Id = ctypes.c_int64
_VISITOR = ctypes.CFUNCTYPE(ctypes.c_int, _Id, ctypes.c_char_p, ctypes.POINTER(ctypes.c_int), ctypes.c_void_p)


def refuse(path: Path, netcdf4: ModuleType) -> None:
    """Refuse an HDF5 file that refers to another file.

    Raises
    ------
    InputError
        It does. A file that cannot be opened is left to its reader.
    """
    library = _library(netcdf4)
    if library is None:
        return
    file = library.H5Fopen(str(path).encode(), 0, _DEFAULT)
    if file < 0:
        return
    outside: list[str] = []

    def visit(group: int, name: bytes, kind: Any, _: Any) -> int:
        what = ""
        if kind[0] == _EXTERNAL:
            what = "is a link to another file"
        elif kind[0] == _HARD and _is_outside(library, group, name):
            what = "has its values in another file"
        if what:
            outside.append(f"{name[:200].decode(errors='replace')} {what}")
        return 1 if what else 0

    try:
        _walk(library)(file, _BY_NAME, _NATIVE, _VISITOR(visit), None)
    finally:
        library.H5Fclose(file)
    if outside:
        raise input_error(
            path, f"{outside[0]}, which is not read; copy it into this file (nccopy or h5repack)"
        )


def _is_outside(library: Any, group: int, name: bytes) -> bool:
    """Check whether an object is a data set whose values are in other files."""
    entry = library.H5Oopen(group, name, _DEFAULT)
    if entry < 0:
        return False
    try:
        if library.H5Iget_type(entry) != _DATASET:
            return False
        creation = library.H5Dget_create_plist(entry)
        elsewhere = library.H5Pget_external_count(creation) > 0 or library.H5Pget_layout(creation) == _VIRTUAL
        library.H5Pclose(creation)
        return elsewhere
    finally:
        library.H5Oclose(entry)


def _walk(library: Any) -> Any:
    """Return the function that visits all links of a file; HDF5 1.10 has its first version only."""
    function = library.H5Lvisit2 if hasattr(library, "H5Lvisit2") else library.H5Lvisit
    function.argtypes = [_Id, ctypes.c_int, ctypes.c_int, _VISITOR, ctypes.c_void_p]
    return function


def _library(netcdf4: ModuleType) -> Any:
    """Return the HDF5 library that netCDF4 has loaded; None if the system does not show it."""
    try:
        library = ctypes.PyDLL(netcdf4._netCDF4.__file__)
        declared: dict[str, tuple[Any, list[Any]]] = {
            "H5Fopen": (_Id, [ctypes.c_char_p, ctypes.c_uint, _Id]),
            "H5Fclose": (ctypes.c_int, [_Id]),
            "H5Eset_auto2": (ctypes.c_int, [_Id, ctypes.c_void_p, ctypes.c_void_p]),
            "H5Oopen": (_Id, [_Id, ctypes.c_char_p, _Id]),
            "H5Oclose": (ctypes.c_int, [_Id]),
            "H5Iget_type": (ctypes.c_int, [_Id]),
            "H5Dget_create_plist": (_Id, [_Id]),
            "H5Pget_external_count": (ctypes.c_int, [_Id]),
            "H5Pget_layout": (ctypes.c_int, [_Id]),
            "H5Pclose": (ctypes.c_int, [_Id]),
        }
        for name, (result, arguments) in declared.items():
            function: Callable[..., Any] = getattr(library, name)
            function.restype, function.argtypes = result, arguments  # type: ignore[attr-defined]
        _walk(library)
    except (OSError, AttributeError):
        return None
    library.H5Eset_auto2(0, None, None)  # no report on stderr
    return library
