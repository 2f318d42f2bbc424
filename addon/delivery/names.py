"""Files of a delivery: finished pictures and films of a folder, and their names by a pattern."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from ..errors import UsageError, input_error
from ..progress import count
from ..render import manifest
from ..shot import passes

_FIELDS = ("camera", "pass", "version", "frame", "ext")
_FRAME = re.compile(r"[._-]?\{frame\}")  # films have no frame number
_DIGITS = 4
_VALUE = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]*")
"""Values of a manifest that may stand in a file name, after `passes.file_stem`."""


@dataclass(frozen=True)
class File:
    """A file of a delivery.

    Attributes
    ----------
    source
        Finished file.
    pattern
        Its path in the version; only `{version}` is open.
    bytes, sha256
        Size and hash, as the store of the film lists them.
    facts
        Camera, pass, frame, delivered frame number, time and credits.
    """

    source: Path
    pattern: str
    bytes: int
    sha256: str
    facts: dict[str, Any]


@dataclass(frozen=True)
class Selection:
    """Files of a delivery, and messages on omitted files."""

    files: list[File]
    messages: list[str]


def check(pattern: str) -> None:
    """Check a pattern of file names.

    Raises
    ------
    UsageError
        It has unknown or missing fields, or leads out of the folder.
    """
    try:
        parsed = [part[1:] for part in string.Formatter().parse(pattern) if part[1] is not None]
    except ValueError as error:
        raise UsageError(f"--pattern: {error}; write fields as {{frame}}") from None
    fields = [name for name, _, _ in parsed]
    known = ", ".join(f"{{{name}}}" for name in _FIELDS)
    for name in fields:
        if name not in _FIELDS:
            raise UsageError(f"--pattern: {{{name}}} is not one of {known}; replace it")
    if any(form or change for _, form, change in parsed):
        raise UsageError(f"--pattern: fields have no format; write them as {known}")
    if missing := [name for name in ("frame", "ext") if name not in fields]:
        raise UsageError(
            f"--pattern: {{{missing[0]}}} is missing; use a pattern such as shot.{{frame}}.{{ext}}"
        )
    text = pattern.translate(str.maketrans("", "", "{}"))
    parts = pattern.split("/")
    if not re.fullmatch(r"[A-Za-z0-9_./-]+", text) or any(part in ("", ".", "..") for part in parts):
        reason = "names files below a folder; use letters, digits, - _ . and / between folders"
        raise UsageError(f"--pattern: {pattern} {reason}")


def choose(out: Path, pattern: str, start: int) -> Selection:
    """Choose the finished files of an output folder of `firetwin render`, and name them.

    Parameters
    ----------
    start
        Number of frame 1.

    Raises
    ------
    InputError
        The folder has no finished frames, or its manifest has values that cannot be part of a file name.
    UsageError
        The pattern gives two files the same name.
    """
    chosen, missing = [], []
    for path, entry in sorted(manifest.read(out)["files"].items()):
        if not {"camera", "pass", "sha256", "bytes"} <= entry.keys():
            continue
        source = out / path
        if not source.resolve().is_relative_to(out.resolve()) or not source.is_file():
            missing.append(path)
            continue
        chosen.append(
            File(
                source,
                _name(pattern, path, _checked(out, path, entry), start),
                entry["bytes"],
                entry["sha256"],
                dict(_facts(path, entry, start)),
            )
        )
    if not chosen:
        raise input_error(out, "has no finished pictures or films; name a folder of firetwin render --out")
    if all(each.facts.get("frame") is None for each in chosen):
        raise input_error(out, "has films and none of their frames; run firetwin render --resume for them")
    names: dict[str, File] = {}
    for each in chosen:
        if (other := names.setdefault(each.pattern.lower(), each)) is not each:
            both = f"{other.source.name} and {each.source.name}"
            raise UsageError(f"--pattern: {both} would both be {each.pattern}; add {{camera}} or {{pass}}")
    messages = (
        [f"{count(len(missing), 'file')} of the manifest missing, such as {missing[0]}"] if missing else []
    )
    return Selection(chosen, messages)


def _checked(out: Path, path: str, entry: dict[str, Any]) -> dict[str, Any]:
    """Check the values of an entry that become parts of file names, and return the entry.

    Raises
    ------
    InputError
        One cannot be part of a file name, such as ``../x``.
    """
    values = [entry["camera"], entry["pass"], PurePosixPath(path).suffix[1:], entry.get("film") or "review"]
    texts = [passes.file_stem(each) if isinstance(each, str) else "" for each in values]
    number = entry.get("frame")
    if all(map(_VALUE.fullmatch, texts)) and (number is None or type(number) is int):
        return entry
    raise input_error(
        out / manifest.NAME,
        f"names {path!r} with values that cannot be part of a file name; render it again with --resume",
    )


def _name(pattern: str, path: str, entry: dict[str, Any], start: int) -> str:
    if entry.get("frame") is None:
        pattern = _FRAME.sub("", pattern)
    kind = entry.get("film", "review")
    values = {
        "{camera}": passes.file_stem(entry["camera"]),
        "{pass}": entry["pass"] if kind == "review" else f"{entry['pass']}_{kind}",
        "{frame}": f"{_number(entry, start):0{_DIGITS}d}",
        "{ext}": PurePosixPath(path).suffix[1:],
    }
    for field, value in values.items():
        pattern = pattern.replace(field, value)
    each, file = passes.known().get(entry["pass"]), PurePosixPath(path)
    if each and file.suffix[1:] in each.linked:
        return str(PurePosixPath(pattern).with_name(file.name))
    return pattern


def _number(entry: dict[str, Any], start: int) -> int:
    return start + (entry.get("frame") or 1) - 1


def _facts(path: str, entry: dict[str, Any], start: int) -> Iterator[tuple[str, Any]]:
    yield "source", path
    yield from ((key, value) for key, value in entry.items() if key not in ("bytes", "sha256"))
    if entry.get("frame") is not None:
        yield "number", _number(entry, start)
