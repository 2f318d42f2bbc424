"""Install commands for missing Python packages: the extras of `pyproject.toml`, with NumPy as installed."""

from __future__ import annotations

import importlib.metadata
import shlex
import subprocess
import sys

EXTRAS = {
    "models": ("netCDF4", "rasterio", "pyproj", "zarr"),
    "score": ("shapely", "pyproj", "pyshp"),
    "resources": ("scipy",),
    "tiles": ("urllib3",),
    "raster": ("rasterio",),
    "bench": ("pandas", "pymap3d", "pyproj", "mpmath", "flip-evaluator"),
}
"""Packages of each extra that a message names."""


def install(extra: str) -> str:
    """Return the command that installs an extra.

    Blender's own Python does not know Firetwin as a distribution, so the command names the packages there.
    """
    try:
        importlib.metadata.distribution("firetwin")
    except importlib.metadata.PackageNotFoundError:
        return install_packages(*EXTRAS[extra])
    return install_packages(f"firetwin[{extra}]")


def install_for(package: str) -> str:
    """Return the command that installs the first extra with a package."""
    return install(next(extra for extra, packages in EXTRAS.items() if package in packages))


def install_packages(*packages: str) -> str:
    """Return the command that installs packages, and holds NumPy: Blender's module needs its version."""
    import numpy as np

    words = [sys.executable, "-m", "pip", "install", *packages, f"numpy=={np.__version__}"]
    return subprocess.list2cmdline(words) if sys.platform == "win32" else shlex.join(words)
