"""In-place update of a scene file: changed keys are written into its text; comments, order and layout stay.

The text is split into blocks, one for each table with the comments directly above it. So the comments of a
camera move with it. Within a block tomlkit edits the keys.
"""

from __future__ import annotations

import itertools
import os
import re
import tomllib
from collections.abc import Iterator, Set
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT

from ... import files, output, unfinished
from ...errors import Error, input_error
from ...limits import SETTINGS_BYTES
from ...toml_text import Where, places, tables
from ..schema.former import FORMER, FORMER_KEYS, FORMER_VALUES
from . import Settings
from .scene_file import parse, text

Values = dict[str, Any]


@dataclass(frozen=True)
class Block:
    """Block of a text: path of its table, comments directly above it, header and keys, and trailing lines."""

    path: Where
    lead: str
    body: str
    gap: str


def save(whole: Settings) -> None:
    """Write settings to their own file; an existing scene file is updated as by `updated`.

    Raises
    ------
    InputError
        The file cannot be written, is a link, or is not a scene file.
    """
    path = whole.path
    if os.path.lexists(path):
        before = _read(path)
        new = updated(before.replace("\r\n", "\n"), whole)
    else:
        output.check(path)
        before, new = "", text(whole)
    with unfinished.folder(path) as folder:
        part = folder / path.name
        part.write_text(new, encoding="utf-8", newline="\r\n" if "\r\n" in before else "\n")
        files.publish(part, path)


def _read(path: Path) -> str:
    """Read a scene file that may be replaced; returns its text with its line ends.

    Raises
    ------
    InputError
        It is another file, a link, or write-protected.
    """
    output.check(path, overwrite=True, root=path.parent)
    if path.is_symlink():
        raise input_error(path, "is a link, which is not followed; choose another name")
    files.check_size(path, SETTINGS_BYTES)
    try:
        before = path.read_bytes().decode("utf-8-sig")
        parse(before.replace("\r\n", "\n"), path)
    except (Error, OSError, ValueError, RecursionError):
        raise input_error(path, "exists already and is not a scene file; choose another name") from None
    return before


def updated(there: str, whole: Settings) -> str:
    """Update the scene file `there` to the settings `whole`; only lines of changed keys differ.

    A text that is not a scene file, or whose layout cannot be preserved, is replaced by `scene_file.text`.
    """
    fresh = text(whole)
    try:
        edited = _written(_with_current_names(there), fresh, whole)
        if _values(edited, whole) == tomllib.loads(fresh):
            return edited
    except (Error, TOMLKitError, ValueError, RecursionError):
        pass
    return fresh


def _values(there: str, whole: Settings) -> Values:
    """Return the values of all keys as `text` writes them, defaults included."""
    return tomllib.loads(text(parse(there, whole.path)))


def _with_current_names(there: str) -> str:
    """Replace former names of sections, keys and values in a text by the present names."""
    for former, now in FORMER.items():
        there = re.sub(rf"(?m)^(\s*\[\s*){former}(?=\s*[\].])", rf"\g<1>{now}", there)
    tomllib.loads(there)  # only a valid text has positions
    lines, positions = there.split("\n"), places(there)
    found = [(positions[each], *each) for each in FORMER_KEYS | FORMER_VALUES if each in positions]
    for (line, column), section, former in sorted(found, reverse=True):  # from the end of each line
        now = FORMER_KEYS.get((section, former), former)
        before, pair = lines[line - 1][: column - 1], lines[line - 1][column - 1 :]
        if pair.startswith(former):
            lines[line - 1] = before + _with_current_value(section, now, pair.removeprefix(former))
    return "\n".join(lines)


def _with_current_value(section: str, key: str, rest: str) -> str:
    """Write a key and the rest of its line, in which a former value is replaced."""
    for former, now in FORMER_VALUES.get((section, key), {}).items():
        rest = re.sub(rf"^(\s*=\s*)([\"']){former}\2", rf"\g<1>\g<2>{now}\g<2>", rest)
    return key + rest


def _written(there: str, fresh: str, whole: Settings) -> str:
    was, now = _values(there, whole), tomllib.loads(fresh)
    blocks, made = list(_blocks(there)), list(_blocks(fresh))
    for name in now:
        if isinstance(now[name], dict):
            blocks = _with_section(blocks, name, was, now)
    blocks = _with_lists(blocks, made, (), was, now)
    return "".join(b.lead + _edited(b, blocks, was, now) + b.gap for b in blocks)


def _blocks(there: str) -> Iterator[Block]:
    there += "" if there.endswith("\n") or not there else "\n"
    spans = tables(there)
    starts = [there.rfind("\n", 0, start) + 1 for _, start, _ in spans] + [len(there)]
    lead = ""
    for (path, _, end), start, following in zip(spans, starts, starts[1:], strict=False):
        over = there.find("\n", end) + 1 if end else 0
        lines = there[over:following].splitlines(keepends=True)
        above = list(itertools.takewhile(lambda line: line.lstrip().startswith("#"), reversed(lines)))
        count = len(lines) - (len(above) if following < len(there) else 0)
        yield Block(path, lead, there[start:over], "".join(lines[:count]))
        lead = "".join(lines[count:])


def _with_section(blocks: list[Block], name: str, was: Values, now: Values) -> list[Block]:
    """Insert the missing header of a changed section, in the order of the schema."""
    if was.get(name) == now[name] or any(block.path[:1] == (name,) for block in blocks):
        return blocks
    if name in tomllib.loads(blocks[0].body):  # inline table or dotted keys
        return blocks
    order = list(now)
    before = set(order[: order.index(name)])
    at = max(i for i, block in enumerate(blocks) if not block.path or block.path[0] in before) + 1
    return [
        *_spaced(blocks[:at]),
        Block((name,), "", f"[{name}]\n", "\n" if blocks[at:] else ""),
        *blocks[at:],
    ]


def _with_lists(
    blocks: list[Block], added: list[Block], path: Where, was: Values, now: Values
) -> list[Block]:
    """Update the lists of tables in the table at `path`, and those nested in them."""
    for name in {**was, **now}:
        here = (*path, name)
        size = len(here)
        if any(block.path[:size] == here and len(block.path) > size for block in blocks + added):
            blocks = _with_list(blocks, added, here, name, was, now)
            for i, (old, new) in enumerate(zip(was.get(name, []), now.get(name, []), strict=False)):
                if any(block.path == (*here, i) for block in blocks):  # else it is an inline table
                    blocks = _with_lists(blocks, added, (*here, i), old, new)
    return blocks


def _with_list(
    blocks: list[Block], added: list[Block], path: Where, name: str, was: Values, now: Values
) -> list[Block]:
    """Reorder, add and remove the tables of a list; `was` is changed accordingly."""
    size = len(path)
    old, new = was.get(name, []), now.get(name, [])
    mine = [i for i, block in enumerate(blocks) if block.path[:size] == path]
    sources = _sources(old, new)
    if (old and not mine) or sources == list(range(len(old))):  # inline tables, or unchanged
        return blocks
    units: list[Block] = []
    for i, source in enumerate(sources):
        of = (added, i) if source is None else (blocks, source)
        unit = [block for block in of[0] if block.path[: size + 1] == (*path, of[1])]
        units += _spaced([replace(block, path=(*path, i, *block.path[size + 1 :])) for block in unit])
    was[name] = [new[i] if source is None else old[source] for i, source in enumerate(sources)]
    owner = (
        [i for i, block in enumerate(blocks) if block.path == path[:-1]] if size > 1 else [len(blocks) - 1]
    )
    at = mine[0] if mine else owner[-1] + 1
    rest = [block for block in blocks[at:] if block.path[:size] != path]
    return [*(_spaced(blocks[:at]) if units else blocks[:at]), *units, *rest]


def _sources(old: list[Values], new: list[Values]) -> list[int | None]:
    """Index of the old table of each new one: by name, or by position after a renaming."""
    names, wanted = [values.get("name") for values in old], {values.get("name") for values in new}
    sources: list[int | None] = []
    for i, values in enumerate(new):
        named = names.index(values["name"]) if values.get("name") in names and "name" in values else None
        same = i < len(old) and (names[i] is None or names[i] not in wanted)
        sources.append(named if named is not None else i if same else None)
    return sources


def _spaced(blocks: list[Block]) -> list[Block]:
    """End the last block with a blank line."""
    *most, last = blocks
    loose = last.gap or not (last.lead + last.body)
    return [*most, last if loose else replace(last, gap="\n")]


def _edited(block: Block, blocks: list[Block], was: Values, now: Values) -> str:
    """Header and keys of a block, with changed keys updated."""
    document: Any = tomlkit.parse(block.body)
    table = document
    before: Any = was
    after: Any = now
    for step in block.path:
        if isinstance(step, str):
            table = table[step]
            table = table[0] if isinstance(table, AoT) else table
        before, after = before[step], after[step]
    size = len(block.path)
    apart = {
        other.path[size] for other in blocks if len(other.path) > size and other.path[:size] == block.path
    }
    return tomlkit.dumps(document) if _put(table, before, after, apart) else block.body


def _put(table: Any, was: Any, now: Any, apart: Set[str | int] = frozenset()) -> bool:
    """Update keys of a tomlkit table except those `apart`; return whether any changed."""
    changed = [name for name in {**was, **now} if name not in apart and was.get(name) != now.get(name)]
    for name in changed:
        value, before = now.get(name), was.get(name)
        if name not in now:
            table.pop(name, None)
        elif name in table and isinstance(value, dict):
            _put(table[name], before, value)
        elif name in table and _tables(value) and _tables(before) and len(value) == len(before):
            for inner, old, new in zip(table[name], before, value, strict=True):
                _put(inner, old, new)
        else:
            table[name] = _item(value)
    return bool(changed)


def _tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _item(value: Any) -> Any:
    """Convert a value for tomlkit; tables are written in one line."""
    if isinstance(value, list):
        array = tomlkit.array()
        for item in value:
            array.append(_item(item))
        return array
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        for name, item in value.items():
            table[name] = _item(item)
        return table
    return tomlkit.item(value)
