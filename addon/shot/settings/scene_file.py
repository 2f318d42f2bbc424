"""Scene file reader: parses TOML into validated `Settings`; errors name line and column."""

from __future__ import annotations

import dataclasses
import math
import os
import typing
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ...did_you_mean import suggestion
from ...errors import reading
from ...limits import RUN_YEARS
from ...toml_text import loads
from ..schema import Field, Key, Where, either, fields, items, validate
from ..schema.former import FORMER, FORMER_KEYS, FORMER_VALUES, REMOVED
from ..schema.frame_list import FrameList
from ..schema.scene_text import SceneText, load
from ..sections import Time
from . import Settings
from .toml_writer import portable, text, with_absolute_tilesets

__all__ = ["parse", "portable", "read", "text", "with_absolute_tilesets"]


def read(path: str | Path) -> Settings:
    """Read and validate a scene file; relative paths start at its folder.

    Raises
    ------
    InputError
        The error names the file, line and column, and the remedy.
    """
    path = Path(path)
    with reading(path):
        text = load(path)
        settings = parse(text, path)
        if invalid := validate(settings):
            raise TableReader(path, text).error(*invalid)
        return settings


def parse(text: str, path: Path) -> Settings:
    """Parse a text as if it were the file `path`: types are checked, values are not.

    Raises
    ------
    InputError
        As `read`.
    """
    values, reader = loads(path, text), TableReader(path, text)
    return reader.table(Settings, reader.current(values), ())


class TableReader(SceneText):
    """Makes dataclasses of tables; bounds and choices are validated by `schema.validate`.

    Parameters
    ----------
    noun
        Kind of file, for messages.
    """

    def __init__(self, path: Path, text: str, noun: str = "scene file") -> None:
        super().__init__(path, text)
        self.noun = noun
        self.former: list[str] = []

    def current(self, values: dict[str, Any]) -> dict[str, Any]:
        """Translate former sections, keys and values to their present names, with a note."""
        renamed = self.renamed(values, {(name,): now for name, now in FORMER.items()}, (), "[{}]")
        keys: dict[Where, str] = {(*where,): now for where, now in FORMER_KEYS.items()}
        for section in {section for section, _ in FORMER_KEYS}:
            if isinstance(renamed.get(section), dict):
                renamed[section] = self.renamed(renamed[section], keys, (section,), f"{section}.{{}}")
        for (section, key), new_values in FORMER_VALUES.items():
            table = renamed.get(section)
            if not isinstance(table, dict):
                continue
            then = table.get(key)
            if isinstance(then, str) and then in new_values:
                reason = (
                    f'{section}.{key} = "{then}" is called "{new_values[then]}" now; the old value is read'
                )
                self.former.append(str(self.error((section, key), f"{reason} in this version only")))
                renamed[section] = {**table, key: new_values[then]}
        return self.without_removed(renamed)

    def without_removed(self, values: dict[str, Any]) -> dict[str, Any]:
        """Leave out removed keys that have their former default, with a note.

        Raises
        ------
        InputError
            A removed key has another value.
        """
        for (section, key), removed in REMOVED.items():
            table = values.get(section)
            if not isinstance(table, dict) or key not in table:
                continue
            gone = self.error(
                (section, key), f"{section}.{key} was removed: {removed.reason}; delete the line"
            )
            if table[key] != removed.default:
                raise gone
            self.former.append(str(gone))
            values = values | {section: {name: value for name, value in table.items() if name != key}}
        return values

    def renamed(
        self, values: dict[str, Any], former: dict[Where, str], where: Where, shown: str
    ) -> dict[str, Any]:
        """Rename keys of a table from their `former` names."""
        names = {name: former.get((*where, name), name) for name in values}
        for name, now in names.items():
            if name == now:
                continue
            here, then = (*where, now), shown.format(name)
            if now in values:
                raise self.error(
                    here, f"{then} is the former name of {shown.format(now)}, which is there too"
                )
            reason = f"{then} is called {shown.format(now)} now; the old name is read in this version only"
            self.former.append(str(self.error(here, reason)))
        return {names[name]: value for name, value in values.items()}

    def table(self, kind: type, values: dict[str, Any], where: Where) -> Any:
        """Convert a table to the dataclass `kind`; missing keys take their defaults."""
        own = {part.name: part for part in fields(kind) if not part.key.variants}
        rig = next((part for part in fields(kind) if part.key.variants), None)
        rig_kind, tag = self.kind(rig.key, values, where) if rig else (None, ())
        flat = {part.name: part for part in fields(rig_kind)} if rig_kind else {}
        for name in values:
            if name not in own and name not in flat and name not in tag:
                raise self.error((*where, name), self.unknown(name, [*tag, *own, *flat], rig, where))
        kwargs = {name: self.part(part, values, where) for name, part in own.items()}
        if rig and rig_kind:
            kwargs[rig.name] = rig_kind(
                **{name: self.part(part, values, where) for name, part in flat.items()}
            )
        if kind is Settings:
            kwargs |= {"path": self.path, "notes": tuple(self.former)}
        if kind is Time:
            return Time(**kwargs).with_frames(values)
        return kind(**kwargs)

    def kind(self, key: Key, values: dict[str, Any], where: Where) -> tuple[type, tuple[str]]:
        """Dataclass selected by the key `tag` of a table, and the tag."""
        here, name = (*where, key.tag), values.get(key.tag, key.default_kind)
        if reason := key.invalid(self.expect(str, name, here)):
            raise self.error(here, f"{_dotted(here)} {reason}")
        return key.all_variants()[name], (key.tag,)

    def unknown(self, name: str, names: list[str], rig: Field | None, where: Where) -> str:
        """Error message for an unknown key."""
        kinds = rig.key.all_variants() if rig else {}
        having = [kind for kind, made in kinds.items() if name in (part.name for part in fields(made))]
        if rig and having:
            return f"{name} belongs to {rig.key.tag} {either(having)}; known here: {', '.join(names)}"
        place = f"in [{_dotted(where)}]" if where else f"in a {self.noun}"
        return f'unknown key "{name}" {place}' + (
            suggestion(name, names) or f"; known here: {', '.join(names)}"
        )

    def part(self, part: Field, values: dict[str, Any], where: Where) -> Any:
        """Value of a key of a table."""
        if part.name in values:
            return self.value(part.type, values[part.name], (*where, part.name))
        own = part.type is Path and part.default is not None
        return self.path.parent / part.default if own else part.default

    def value(self, kind: Any, value: Any, where: Where) -> Any:
        """Convert a value to the type of its dataclass field."""
        if isinstance(value, int) and abs(value) >= 2**63:
            raise self.error(where, f"{_dotted(where)} is larger than a number in TOML may be")
        if isinstance(kind, type) and dataclasses.is_dataclass(kind):
            return self.table(kind, self.expect(dict, value, where), where)
        if typing.get_origin(kind) is tuple:
            return self.tuple(kind, self.expect(list, value, where), where)
        if kind is Path:
            return self.path.parent / os.path.expanduser(self.name(value, where))
        if kind is datetime:
            return self.moment(self.expect(datetime, value, where), where)
        if kind is float:
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise self.error(where, f"{_dotted(where)} must be a number, not {_shown(value)}")
            return float(value)
        if kind is FrameList:
            return FrameList(self.expect(str, value, where))
        return self.expect(kind, value, where)

    def name(self, value: Any, where: Where) -> str:
        """Validate a file or folder name."""
        if "\0" in self.expect(str, value, where):
            raise self.error(
                where, f"{_dotted(where)} holds the character of number 0, which no file's name may"
            )
        return value

    def moment(self, moment: datetime, where: Where) -> datetime:
        """Convert a date and time to UTC."""
        if moment.tzinfo is None:
            reason = "has no zone; end it in Z (UTC) or in an offset like -07:00"
            raise self.error(where, f"{_dotted(where)} {reason}")
        first, last = RUN_YEARS
        if not first <= moment.year <= last:
            raise self.error(where, f"{_dotted(where)} lies outside of the years {first} to {last}")
        return moment.astimezone(UTC)

    def tuple(self, kind: Any, values: list[Any], where: Where) -> tuple[Any, ...]:
        """Convert a list to the tuple type `kind`."""
        inner = items(kind, len(values))
        if len(inner) != len(values):
            raise self.error(where, f"{_dotted(where)} must hold {len(inner)} values, not {len(values)}")
        return tuple(
            self.value(k, v, (*where, i)) for i, (k, v) in enumerate(zip(inner, values, strict=True))
        )

    def expect(self, kind: type, value: Any, where: Where) -> Any:
        """Check a value's type and return the value."""
        if type(value) is kind:
            return value
        raise self.error(where, f"{_dotted(where)} must be {_TYPES[kind]}, not {_shown(value)}")


_TYPES = {
    dict: "a table",
    list: "a list in [ ]",
    str: "text in quotes",
    int: "a whole number",
    bool: "true or false",
    datetime: "a date and time such as 2014-09-17T21:30:00Z",
}


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    return "a table" if isinstance(value, dict) else "a list" if isinstance(value, list) else str(value)


def _dotted(where: Where) -> str:
    """("cameras", 0, "keys", 1) -> ``cameras.keys (number 2)``: counted from one, as people do."""
    return ".".join(str(p) for p in where if isinstance(p, str)) + "".join(
        f" (number {p + 1})" for p in where[-1:] if isinstance(p, int)
    )
