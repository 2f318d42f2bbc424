"""Optional packages (extra "models") for reading other models' files."""

from __future__ import annotations

import importlib
import os
import sys
from types import ModuleType

from ...errors import Error

ALL = "netCDF4 pyproj pyshp rasterio zarr"


def package(name: str) -> ModuleType:
    """Import an optional package.

    HDF5 reads the variable HDF5_USE_FILE_LOCKING when it loads. Locks are disabled, unless the user has set
    it: the lock of a reader makes the next write of a running model fail.

    Raises
    ------
    Error
        The package is missing; the message has the install command.
    """
    os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")
    try:
        return importlib.import_module(name)
    except ImportError:
        pip = f"{sys.executable} -m pip install"
        raise Error(
            f"reading this needs the Python package {name}; install it with: {pip} {name} "
            f"(or all that models' files need: {pip} {ALL})"
        ) from None
