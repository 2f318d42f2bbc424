"""Optional packages (extra "models") for reading other models' files."""

from __future__ import annotations

import importlib
import os
from types import ModuleType

from ... import extras
from ...errors import Error


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
        pip = extras.install_for(name)
        raise Error(f"reading this needs the Python package {name}; install it with: {pip}") from None
