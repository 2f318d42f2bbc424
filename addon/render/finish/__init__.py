"""Finishing of pictures: each module writes the files of the pass of its name, or completes rendered files.

A module defines `finish`, unless its name begins with "_". It runs without Blender.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ... import plugins
from ...errors import Error

if TYPE_CHECKING:
    from ...shot.shot import Shot

Files = Mapping[str, Path]
"""Files of a picture, by suffix."""

Finish = Callable[[Files, Mapping[str, Files], "Shot", str, int], None]
"""Finishes a picture. Arguments: the pass's files; the files of the passes that it needs, by need
(``need@run`` for another run); the shot; the camera's name; and the frame."""

FOLDER = Path(__file__).parent


@functools.cache
def finisher(name: str) -> Finish:
    """Look up the function that finishes pictures of a pass.

    Raises
    ------
    Error
        A Python package that it needs is not installed.
    """
    try:
        found: Finish = plugins.module(__name__, name).finish
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith(__name__):
            raise
        raise Error(f"the {name} pass needs {error.name}, which is not in Blender: pip install it") from None
    return found


def code_files(name: str) -> list[str]:
    """List the files and folders of the package that finish pictures of a pass."""
    helpers = sorted(path.name for path in FOLDER.glob("_[a-z]*.py"))
    return ["imaging", *(f"render/finish/{file}" for file in (f"{name}.py", *helpers))]
