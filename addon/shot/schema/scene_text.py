"""Text of a scene file, with the line and column of each value for error messages."""

from __future__ import annotations

from pathlib import Path

from ...errors import InputError, input_error, reading
from ...files import read_text
from ...limits import SETTINGS_BYTES
from ...toml_text import Where, places
from .former import current


class SceneText:
    """Text of a scene file.

    Attributes
    ----------
    path
        The file.
    places
        Line and column of each value, from 1, by its path under present names.
    """

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.places = {current(where): at for where, at in places(text).items()}

    def error(self, where: Where, reason: str) -> InputError:
        """Make an error at a value, or at the nearest enclosing table in the text."""
        while where and where not in self.places:
            where = where[:-1]
        line, column = self.places.get(where, (0, 0))
        return input_error(self.path, reason, line=line, column=column)


def error_at(path: Path, where: Where, reason: str) -> InputError:
    """Make an error at the value with the path `where` (names and indices), for checks after reading."""
    return SceneText(path, load(path)).error(where, reason)


def load(path: Path) -> str:
    """Read the text of a scene file.

    Raises
    ------
    InputError
        It does not exist, is a folder or is not text.
    """
    if path.is_dir():
        raise input_error(path, _folder(path))
    with reading(path):
        try:
            return read_text(path, "utf-8-sig", most=SETTINGS_BYTES)
        except FileNotFoundError:
            raise input_error(path, "no such scene file; examples/king_fire.toml shows every key") from None


def _folder(path: Path) -> str:
    """Error message for a folder in place of a scene file."""
    if (path / "run.toml").is_file():
        return (
            f"is a run folder, and a scene file is wanted; this writes one: firetwin new {path} -o SCENE.toml"
        )
    inside = sorted(path.glob("*.toml"))
    return "is a folder, and a scene file is wanted, such as " + (
        f"{inside[0]}" if inside else "examples/king_fire.toml, which shows every key"
    )
