"""Declaration of the pass of one band of a satellite imager."""

from __future__ import annotations

from . import DerivedPass


def band(name: str, order: int, help: str) -> DerivedPass:
    """Declare the pass of one band."""
    return DerivedPass(
        name=name,
        order=order,
        help=help,
        files=("png",),
        film=True,
        aspects=frozenset({"time", "camera"}),
        needs=("depth",),
        code=("shot/satellites",),
    )
