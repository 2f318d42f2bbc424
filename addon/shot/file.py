"""Reads a scene file: TOML in, a checked `Project` out, and every mistake named with its line and column."""

from __future__ import annotations

import dataclasses
import difflib
import math
import re
import tomllib
import types
import typing
import zoneinfo
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from . import frame_list
from .errors import InputError, input_error
from .project import Camera, CameraKey, Fire, Forest, Light, Project, Render, Smoke, Terrain, Time
from .toml_places import places

PASSES = ("rgb", "depth", "thermal")

Check = Callable[[Any], str | None]


def _between(low: float, high: float = math.inf) -> Check:
    bounds = f"at least {low:g}" if high == math.inf else f"from {low:,g} to {high:,g}"
    return lambda value: None if value is None or low <= value <= high else f"must be {bounds}, not {value:g}"


def _above(low: float) -> Check:
    return lambda value: None if value > low else f"must be above {low:g}, not {value:g}"


def _one_of(*names: str) -> Check:
    listed = " or ".join(f'"{name}"' for name in names)
    return lambda value: (
        None if value in names else f'must be {listed}, not "{value}"' + _nearest(value, names)
    )


def _passes(value: tuple[str, ...]) -> str | None:
    for name in value:
        if name not in PASSES:
            return f'holds "{name}"; a pass is {", ".join(PASSES)}' + _nearest(name, PASSES)
    return "names a pass twice" if len(set(value)) < len(value) else None


def _zone(value: str) -> str | None:
    try:
        zoneinfo.ZoneInfo(value)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        return f'"{value}" is not a time zone' + _nearest(value, sorted(zoneinfo.available_timezones()))
    return None


def _file_name(value: str) -> str | None:
    if re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", value):
        return None
    return f'"{value}" names files, so it is made of letters, digits, - and _'


def _resolution(value: tuple[int, int]) -> str | None:
    if all(16 <= side <= 16384 and side % 2 == 0 for side in value):
        return None
    return "must be two even numbers of pixels from 16 to 16384 (video needs even ones)"


CHECKS: dict[type, dict[str, Check]] = {
    Time: {"frames": _between(1, 100_000), "fps": _between(1, 240), "zone": _zone},
    Terrain: {"near_radius": _between(0), "near_spacing": _above(0), "apron": _between(0)},
    Forest: {"stand_spacing": _above(0), "stand_radius": _between(0), "draw_distance": _between(0)},
    Fire: {
        "emitters": _one_of("front", "cells"),
        "flame_length": _one_of("thomas", "byram"),
        "budget": _between(0),
        "firebrands": _between(0, 100_000),
    },
    Smoke: {"voxel_size": _between(0), "max_age": _above(0), "extinction": _between(0)},
    Light: {"haze": _between(0), "exposure": _between(-20, 20), "lamps": _between(0, 500)},
    Camera: {
        "name": _file_name,
        "kind": _one_of("drone", "satellite"),
        "focal_length": _between(1, 5000),
        "swath": _above(0),
        "passes": _passes,
    },
    CameraKey: {
        "at": _between(0, 1),
        "latitude": _between(-90, 90),
        "longitude": _between(-180, 180),
        "height": _above(0),
        "target": _one_of("point", "head", "fire"),
        "target_latitude": _between(-90, 90),
        "target_longitude": _between(-180, 180),
    },
    Render: {
        "engine": _one_of("cycles", "eevee"),
        "resolution": _resolution,
        "samples": _between(1, 65536),
        "passes": lambda value: _passes(value) if value else 'is empty; name at least one, such as "rgb"',
        "thermal_low": _above(0),
    },
}


def _nearest(name: object, names: typing.Iterable[str]) -> str:
    found = difflib.get_close_matches(str(name), list(names), n=1, cutoff=0.6)
    return f'; did you mean "{found[0]}"?' if found else ""


class _Reader:
    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.places = places(text)

    def error(self, where: tuple[str | int, ...], reason: str) -> InputError:
        """An error at the place of a key, or of the nearest thing round it that is written down."""
        while where and where not in self.places:
            where = where[:-1]
        line, column = self.places.get(where, (0, 0))
        return input_error(self.path, line, column, reason)

    def table(self, kind: type, values: dict[str, Any], where: tuple[str | int, ...]) -> Any:
        """A table of the file as the dataclass `kind`."""
        hints = typing.get_type_hints(kind)
        names = [f.name for f in dataclasses.fields(kind) if not (kind is Project and f.name == "path")]
        fields: dict[str, Any] = {"path": self.path} if kind is Project else {}
        for name, value in values.items():
            here = (*where, name)
            if name not in names:
                place = f"in [{_dotted(where)}]" if where else "in a scene file"
                known = _nearest(name, names) or f"; known here: {', '.join(names)}"
                raise self.error(here, f'unknown key "{name}" {place}{known}')
            fields[name] = self.value(hints[name], value, here)
            check = CHECKS.get(kind, {}).get(name)
            if check and (wrong := check(fields[name])):
                raise self.error(here, f"{_dotted(here)} {wrong}")
        return kind(**fields)

    def value(self, kind: Any, value: Any, where: tuple[str | int, ...]) -> Any:
        """A value of the file as the type that its dataclass field declares."""
        if dataclasses.is_dataclass(kind):
            return self.table(kind, self.expect(dict, value, where), where)
        if isinstance(kind, types.UnionType):  # X | None: the file cannot say None, it leaves the key out
            return self.value(kind.__args__[0], value, where)
        if typing.get_origin(kind) is tuple:
            return self.tuple(typing.get_args(kind), self.expect(list, value, where), where)
        if kind is Path:
            return self.path.parent / Path(self.expect(str, value, where)).expanduser()
        if kind is datetime:
            moment = self.expect(datetime, value, where)
            if moment.tzinfo is None:
                raise self.error(
                    where, f"{_dotted(where)} has no zone; end it in Z (UTC) or in an offset like -07:00"
                )
            return moment.astimezone(UTC)
        if kind is float:
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise self.error(where, f"{_dotted(where)} must be a number, not {_shown(value)}")
            return float(value)
        return self.expect(kind, value, where)

    def tuple(
        self, kinds: tuple[Any, ...], values: list[Any], where: tuple[str | int, ...]
    ) -> tuple[Any, ...]:
        if kinds[-1] is Ellipsis:
            kinds = (kinds[0],) * len(values)
        if len(kinds) != len(values):
            raise self.error(where, f"{_dotted(where)} must hold {len(kinds)} values, not {len(values)}")
        return tuple(
            self.value(k, v, (*where, i)) for i, (k, v) in enumerate(zip(kinds, values, strict=True))
        )

    def expect(self, kind: type, value: Any, where: tuple[str | int, ...]) -> Any:
        if type(value) is kind:
            return value
        raise self.error(where, f"{_dotted(where)} must be {_KINDS[kind]}, not {_shown(value)}")


_KINDS = {
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
    return {dict: "a table", list: "a list"}.get(type(value), str(value))


def _dotted(where: tuple[str | int, ...]) -> str:
    """("cameras", 0, "keys", 1) -> ``cameras.keys (number 2)``: counted from one, as people do."""
    return ".".join(str(p) for p in where if isinstance(p, str)) + "".join(
        f" (number {p + 1})" for p in where[-1:] if isinstance(p, int)
    )


def read(path: str | Path) -> Project:
    """Read and check a scene file; relative paths in it start at its own folder.

    Raises
    ------
    InputError
        Names the file, the line and column of the mistake, and what to do about it.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise input_error(path, 0, 0, "no such scene file; examples/king_fire.toml shows every key") from None
    except (OSError, UnicodeDecodeError) as error:
        raise input_error(
            path, 0, 0, f"cannot be read as text: {getattr(error, 'strerror', None) or error}"
        ) from None
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(path, text, str(error)) from None
    reader = _Reader(path, text)
    project = reader.table(Project, values, ())
    for key in ("run", "cache"):
        if key not in values:
            project = dataclasses.replace(project, **{key: path.parent / getattr(project, key)})
    _cross_check(project, reader)
    return project


def _syntax_error(path: Path, text: str, message: str) -> InputError:
    """Tomllib ends its messages in "(at line 3, column 7)" or "(at end of document)"."""
    found = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    reason = re.sub(r" \(at .*\)$", "", message)
    line, column = (int(found[1]), int(found[2])) if found else (max(1, len(text.splitlines())), 0)
    return input_error(path, line, column, f"not valid TOML: {reason[:1].lower()}{reason[1:]}")


def _cross_check(project: Project, reader: _Reader) -> None:
    """What no single key can say."""
    time = project.time
    if time.start and time.end and time.end <= time.start:
        raise reader.error(("time", "end"), "time.end must be later than time.start")
    if project.render.thermal_high <= project.render.thermal_low:
        raise reader.error(("render", "thermal_high"), "render.thermal_high must be above render.thermal_low")
    names: set[str] = set()
    for i, camera in enumerate(project.cameras):
        here = ("cameras", i)
        if camera.name in names:
            raise reader.error(
                (*here, "name"), f'a second camera is named "{camera.name}"; names must differ'
            )
        names.add(camera.name)
        try:
            frame_list.parse(camera.frames, time.frames)
        except ValueError as error:
            raise reader.error((*here, "frames"), f"cameras.frames: {error}") from None
        if camera.kind == "drone" and not camera.keys:
            raise reader.error(
                here, f'camera "{camera.name}" has no [[cameras.keys]]; a drone needs at least one'
            )
        for k, (before, after) in enumerate(zip(camera.keys, camera.keys[1:], strict=False), start=1):
            if after.at <= before.at:
                raise reader.error(
                    (*here, "keys", k, "at"),
                    f"cameras.keys.at must rise from key to key, not {before.at:g} then {after.at:g}",
                )


def error_at(path: Path, where: tuple[str | int, ...], reason: str) -> InputError:
    """An error about the value that the names and indices `where` lead to, found only after reading."""
    return _Reader(path, path.read_text(encoding="utf-8-sig")).error(where, reason)
