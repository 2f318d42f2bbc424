"""USD library: `pxr` of Blender, or of the package usd-core in a process without Blender.

The two are never loaded into the same process: both register the same types.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..errors import Error

_MISSING = (
    "this Blender has no USD library (the module pxr; builds of Debian leave it out); use Blender from "
    "blender.org, or install the Python package bpy"
)


def load() -> None:
    """Make the modules of `pxr` importable.

    Raises
    ------
    Error
        This Blender has none.
    """
    if "bpy" in sys.modules:
        bundled = getattr(sys.modules["bpy"].utils, "expose_bundled_modules", None)
        if bundled is not None:
            bundled()
    try:
        importlib.import_module("pxr.UsdGeom")
    except ImportError:
        raise Error(_MISSING) from None


def new_stage(
    path: Path, rate: float, span: tuple[int, int] | None = None, root: str = "World", scope: bool = False
) -> Any:
    """Create a layer in metres with z up, whose default prim is an Xform (or a Scope) `root`.

    Parameters
    ----------
    rate
        Frames per second; a time code is a frame.
    span
        First and last frame; None for a layer without time.
    """
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateNew(path.as_posix())
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    if span is not None:
        stage.SetTimeCodesPerSecond(rate)
        stage.SetFramesPerSecond(rate)
        stage.SetStartTimeCode(span[0])
        stage.SetEndTimeCode(span[1])
    kind = UsdGeom.Scope if scope else UsdGeom.Xform
    stage.SetDefaultPrim(kind.Define(stage, f"/{root}").GetPrim())
    return stage


def set_kind(prim: Any, kind: str) -> None:
    """Set the kind of a prim, such as "component"."""
    from pxr import Usd

    Usd.ModelAPI(prim).SetKind(kind)


class Identifiers:
    """Valid and different identifiers for names, which can be any text."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)

    def make(self, name: str) -> str:
        """Return an identifier for a name: ASCII letters, digits and underscores, different from earlier."""
        from pxr import Tf

        plain = Tf.MakeValidIdentifier("".join(c if c.isascii() and c.isalnum() else "_" for c in name[:80]))
        found, number = plain, 2
        while found in self._taken:
            found, number = f"{plain}_{number}", number + 1
        self._taken.add(found)
        return found
