"""Scene file writer: every key with its value and its help as a comment."""

from __future__ import annotations

import json
import zoneinfo
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path
from typing import Any

from ... import files
from ..schema import Field, Key, fields, items, kind_of, plain, summary
from . import Settings

Line = tuple[str, str]  # text, and its comment

_SAMPLES = {  # examples for keys without a value
    datetime: "2014-09-17T21:30:00Z",
    float: "0.0",
    tuple[int, int]: "[1280, 720]",
    Path: '"file.tif"',
}


def text(settings: Settings) -> str:
    """Write a scene file that reads back as these settings: all keys, each with its help at first occurrence.

    Times are in the zone of `settings.time`, paths relative to the folder of the settings if they are in it.
    """
    return _write(settings)


def portable(settings: Settings) -> str:
    """Write a scene file that reads back as these settings in any folder: its paths are absolute."""
    return _write(with_absolute_tilesets(settings), here=False)


def with_absolute_tilesets(settings: Settings) -> Settings:
    """Return settings whose tilesets are absolute paths, if they are paths relative to the scene file."""
    folder, tiles = settings.path.absolute().parent, settings.tiles
    near = [(place, folder / place) for place in tiles.sources]
    sources = tuple(str(path) if path.exists() else place for place, path in near)
    root = str(folder / tiles.root) if tiles.root else ""
    return replace(settings, tiles=replace(tiles, sources=sources, root=root))


def brief(settings: Settings, asked: Collection[str], remarks: Mapping[str, str]) -> str:
    """Short scene file that reads back as these settings: keys that differ from defaults or are `asked` for.

    Parameters
    ----------
    asked
        Keys that are always written, such as "smoke.method" and "cameras.frames".
    remarks
        Comments above cameras, by name; above the file, by "run".
    """
    return _write(settings, asked=frozenset(asked), remarks=remarks)


def tables(name: str, tables: Iterable[Any]) -> str:
    """Write a list of tables as scene file lines without comments; paths are absolute."""
    writer = _Writer(Settings(), here=False)
    blocks = (block for table in tables for block in writer.table(table, (name,), [(f"[[{name}]]", "")]))
    return "".join(f"{line}\n" for block in blocks for line, _ in block if not line.startswith("#"))


def _aligned(block: list[Line]) -> str:
    """Align the comments of a table's lines in one column."""
    width = max(len(written) for written, comment in block if comment) if any(c for _, c in block) else 0
    return "".join(
        (f"{written.ljust(width)}  # {comment}" if comment else written) + "\n" for written, comment in block
    )


def _write(settings: Settings, **options: Any) -> str:
    """Write settings with the `options` of a `_Writer`."""
    blocks = _Writer(settings, **options).table(settings, (), [])
    return "\n".join(_aligned(block) for block in blocks)


class _Writer:
    def __init__(
        self,
        settings: Settings,
        here: bool = True,
        asked: frozenset[str] | None = None,
        remarks: Mapping[str, str] | None = None,
    ) -> None:
        self.asked, self.remarks = asked, remarks or {}
        self.folder = settings.path.parent if here else None
        self.zone = _zone(settings.time.zone)
        self.explained: set[int] = set()

    def table(self, table: Any, section: tuple[str, ...], header: list[Line]) -> Iterator[list[Line]]:
        """Write a dataclass as a block of lines, and nested tables as further blocks."""
        pairs = list(_flat(table))
        placed = self.asked is not None and section[:1] == ("cameras",)
        lines = [self.line(part, value, placed) for part, value in pairs if self.shown(section, part, value)]
        if lines or not header or header[0][0].startswith("[["):
            yield self.remark(section, table) + header + lines
        for part, value in pairs:
            inner = (*section, part.name)
            brackets = "[[{}]]" if part.tables else "[{}]"
            for each in value if part.tables else (value,) if part.table else ():
                head = brackets.format(".".join(inner)), self.once(part.key, _comment(part.key))
                yield from self.table(each, inner, [head])

    def shown(self, section: tuple[str, ...], part: Field, value: Any) -> bool:
        """Return True if a key is written: in a short file if it is requested or differs from its default."""
        if part.table or self.asked is None or part.key.variants:
            return not part.table
        if ".".join((*section, part.name)) in self.asked:
            return True
        same = part.type is not Path and value == part.default
        return not same and value is not None and self.of_key(part, value) != self.usual(part)

    def remark(self, section: tuple[str, ...], table: Any) -> list[Line]:
        """Comment lines above a table."""
        text = self.remarks.get(getattr(table, "name", "") if section else "run", "")
        return [(f"# {line}", "") for line in text.splitlines()]

    def line(self, part: Field, value: Any, placed: bool = False) -> Line:
        """Key, value and comment; the comment has the default unless the key belongs to a placed camera."""
        key = part.key
        if key.variants:
            return f'{key.tag} = "{kind_of(key, value)}"', f"{key.help}: {summary(type(value))}"
        if value is None:
            return f"# {part.name} = {_SAMPLES[part.type]}", self.once(key, _comment(key))
        written, usual = self.of_key(part, value), self.usual(part)
        with_default = usual not in ("", written) and not placed
        comment = _comment(key) + (f" (default {usual})" if with_default else "")
        return f"{part.name} = {written}", self.once(key, comment)

    def usual(self, part: Field) -> str:
        """Default in TOML; empty if there is none."""
        if part.default is None:
            return ""
        return quoted(part.default.as_posix()) if part.type is Path else self.of_key(part, part.default)

    def once(self, key: Key, comment: str) -> str:
        """Return the comment at the key's first occurrence, else an empty text."""
        known = id(key) in self.explained
        self.explained.add(id(key))
        return "" if known else comment

    def of_key(self, part: Field, value: Any) -> str:
        """Value of a key in TOML; a whole number without decimals if its default is one."""
        whole = part.type is float and isinstance(part.default, int) and float(value).is_integer()
        return self.value(int if whole else part.type, int(value) if whole else value)

    def value(self, kind: Any, value: Any) -> str:
        """Value in TOML."""
        if isinstance(value, tuple):
            inner = zip(items(kind, len(value)), value, strict=True)
            return f"[{', '.join(self.value(k, v) for k, v in inner)}]"
        if isinstance(value, Path):
            return quoted(_relative(value, self.folder))
        if isinstance(value, datetime):
            return _moment(value, self.zone)
        if isinstance(value, str):
            return quoted(value)
        return repr(plain(kind, value)).lower()


def quoted(text: str) -> str:
    """Quoted text: TOML has JSON's escapes, and one for DEL."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _flat(table: Any) -> Iterator[tuple[Field, Any]]:
    """Keys of a dataclass with their values; keys of a variant follow the key that selects it."""
    for part in fields(table.__class__):
        value = getattr(table, part.name)
        yield part, value
        if part.key.variants:
            yield from _flat(value)


def _comment(key: Key) -> str:
    """Help with unit and choices, without choices that depend on a folder's files."""
    if key.choices is None or callable(key.choices):
        return key.described()
    *most, last = [f'"{name}" ({words})' if words else f'"{name}"' for name, words in key.names().items()]
    return f"{key.described()}: {', '.join(most)} or {last}"


def _relative(path: Path, folder: Path | None) -> str:
    """Path relative to `folder`; absolute without a folder."""
    if folder is None:
        return path.absolute().as_posix()
    try:
        text = path.relative_to(folder).as_posix()
    except ValueError:
        text = (path if path.is_absolute() else files.relative(path, folder)).as_posix()
    return f"./{text}" if text.startswith("~") else text


def _zone(name: str) -> tzinfo:
    try:
        return zoneinfo.ZoneInfo(name)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        return UTC


def _moment(moment: datetime, zone: tzinfo) -> str:
    """Time in a zone, or in UTC if the zone's offset is invalid in TOML, which has whole minutes."""
    try:
        local = moment.astimezone(zone)
    except OverflowError:
        local = moment.astimezone(UTC)
    if (local.utcoffset() or timedelta()).total_seconds() % 60:
        local = moment.astimezone(UTC)
    return local.isoformat().replace("+00:00", "Z")
