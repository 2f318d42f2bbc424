"""Packages of the optional extra "models", which nothing but reading other models' files needs."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType

from ...errors import Error


def package(name: str) -> ModuleType:
    """Import it.

    Raises
    ------
    Error
        It is not installed; says how to.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        pip = f"{sys.executable} -m pip install {name}"
        raise Error(
            f"reading this needs the Python package {name}; install it with: {pip} "
            "(or all that models' files need: pip install 'firetwin[models]')"
        ) from None
