"""References between files of a folder or an archive, which must not leave it."""

from __future__ import annotations

import posixpath
import re
from urllib.parse import unquote

from ...errors import InputError, input_error

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")
_ESCAPED = re.compile(r"%(2e|2f|5c|00|3a)", re.IGNORECASE)


class LeavesError(InputError):
    """A reference that leaves the folder by `..`."""


def relative(base: str, reference: str, name: str) -> str:
    r"""Resolve a reference of the file `base` to a path within the folder, with `/`.

    Parameters
    ----------
    name
        Name of the file with the reference, for messages.

    Raises
    ------
    LeavesError
        The reference leaves the folder by `..`.
    InputError
        The reference is a URL or absolute, has a drive letter, a backslash or an escaped `.`, `/` or `\\`.
    """
    path = reference.partition("#")[0].partition("?")[0]

    def refused(reason: str, kind: type[InputError] = InputError) -> InputError:
        return input_error(name, f"the reference {reference[:200]!r} {reason}", kind=kind)

    if _SCHEME.match(path) or path.startswith("//"):
        raise refused("is not a file of the tileset: files of a folder refer to files of the folder")
    if _ESCAPED.search(path):
        raise refused("hides a dot, a slash, a backslash or a colon")
    path = unquote(path)
    if "\\" in path or "\0" in path or ":" in path:
        raise refused("has a backslash, a colon or a NUL")
    if path.startswith("/"):
        raise refused("is absolute")
    joined = posixpath.normpath(posixpath.join(posixpath.dirname(base), path))
    if not path:
        raise refused("names no file")
    if joined == ".." or joined.startswith("../"):
        raise refused("leaves the tileset's folder", LeavesError)
    return joined
