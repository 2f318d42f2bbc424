"""Asset library of Firetwin in Blender's preferences: one entry, removed with the add-on.

Only the entry of the folder that Firetwin wrote last is its own. Libraries of the user stay, also if they
are called Firetwin or have the same folder.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

import bpy

from . import preferences

NAME = "Firetwin"

_own: list[str] = []
"""Folder of our entry, if the preferences of the add-on cannot store it."""


def add(folder: Path) -> None:
    """List a folder as the asset library of Firetwin, in place of the previous one."""
    remove()
    libraries = bpy.context.preferences.filepaths.asset_libraries
    if not any(_is_same(each.path, str(folder)) for each in libraries):
        entry = libraries.new(name=NAME, directory=str(folder))
        _store(str(folder))
        with contextlib.suppress(TypeError):  # Blender 5.2 lists this method but does not accept it
            entry.import_method = "APPEND_REUSE"


def remove() -> None:
    """Remove our entry, if the user has not changed its folder."""
    libraries, folder = bpy.context.preferences.filepaths.asset_libraries, stored()
    entry = next((each for each in libraries if folder and _is_same(each.path, folder)), None)
    if entry is not None:
        libraries.remove(entry)
    _store("")


def register() -> None:
    """List the library again that an earlier session wrote."""
    folder = stored()
    if folder and Path(folder).is_dir():
        libraries = bpy.context.preferences.filepaths.asset_libraries
        if not any(_is_same(each.path, folder) for each in libraries):
            libraries.new(name=NAME, directory=folder)


def unregister() -> None:
    """Remove our entry; the preference still names its folder until the add-on is removed."""
    folder = stored()
    remove()
    _store(folder if preferences.get() is not None else "")


def stored() -> str:
    """Return the folder of our entry; empty without one."""
    own = preferences.get()
    return own.library if own is not None else (_own[0] if _own else "")


def _store(folder: str) -> None:
    own = preferences.get()
    if own is not None:
        own.library = folder
    _own[:] = [folder] if folder and own is None else []


def _is_same(path: str, other: str) -> bool:
    return Path(bpy.path.abspath(path)) == Path(other)
