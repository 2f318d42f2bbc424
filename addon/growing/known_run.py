"""Known run: a run as it was known at one of its times, for frames that do not depend on later times.

A film of a growing run shows each frame by the times up to the next one. The same frame of the finished run
is then equal.
"""

from __future__ import annotations

import json
import tomllib
from datetime import date, datetime
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run

from .. import files
from ..errors import reading
from ..limits import SETTINGS_BYTES
from ..run import content

_ARRIVAL = "fuel_arrival_time"
_FRAMES = "{:06d}"


def write(run: Run, count: int, until: float, out: Path, identity: str) -> None:
    """Write the run of the first `count` times, with arrival times up to the last of them.

    If it ends before `until` (s), the last fields are repeated then, so that a shot up to `until` can be
    built. Frames after the last known time must not be rendered.

    Parameters
    ----------
    out
        Folder to write; it must not exist.
    identity
        Text that is equal for all known runs of one film.
    """
    folder, last = Path(run.path), float(run.times[count - 1])
    repeated = until > last
    with reading(folder / "run.toml"):
        description = tomllib.loads(files.read_text(folder / "run.toml", most=SETTINGS_BYTES))
    out.mkdir(parents=True)
    raw, zero = _raw_times(description, run)
    times = [*raw[:count], *([until + zero] if repeated else [])]
    for each in sorted(folder.iterdir()):
        if each.is_dir() and run.has(each.name):
            _link_frames(each, out / each.name, count, repeated)
        elif each.suffix in (".npy", ".txt") and each.stem != _ARRIVAL:
            if each.suffix == ".npy" and _has_times(each, run):
                _copy_times(each, out / each.name, count, repeated)
            else:
                files.link_or_copy(each, out / each.name)
    if run.has(_ARRIVAL):
        known = np.asarray(run.fuel_arrival_time(), np.float64)
        known = np.where(known <= last, known + zero, np.nan)
        files.write(out / f"{_ARRIVAL}.npy", lambda to: np.save(to, known), durable=False)
        description.get("units", {}).pop(_ARRIVAL, None)
    description.pop("interval_s", None)
    description["times_s"] = times
    files.write_text(out / "run.toml", format_toml(description))
    files.write_text(out / content.IDENTITY, json.dumps(identity))


def next_time(times: np.ndarray, moment: float, ended: bool) -> int:
    """Return how many times a frame at a model time needs; 0 if the next time does not exist yet.

    Parameters
    ----------
    times
        (nt,) known model times, s.
    ended
        No further times come: a frame at the last time needs no next one.
    """
    after = int(np.searchsorted(times, moment, side="right"))
    if after < len(times):
        return after + 1
    return len(times) if ended and moment <= times[-1] else 0


def _raw_times(description: dict[str, Any], run: Run) -> tuple[list[float], float]:
    """Return the times as the description has them, and their difference to the run's (s)."""
    if "times_s" in description:
        raw = [float(each) for each in description["times_s"]]
        return raw, raw[0] - float(run.times[0])
    return [float(each) for each in run.times], 0.0


def _link_frames(source: Path, target: Path, count: int, repeated: bool) -> None:
    target.mkdir()
    named = {each.stem: each for each in source.iterdir() if each.suffix in (".npy", ".txt")}
    for index in range(count + repeated):
        each = named[_FRAMES.format(min(index, count - 1))]
        files.link_or_copy(each, target / f"{_FRAMES.format(index)}{each.suffix}")


def _has_times(path: Path, run: Run) -> bool:
    shape = np.load(path, mmap_mode="r").shape
    return len(shape) == (4 if path.stem.endswith("_3d") else 3) and shape[0] == len(run.times)


def _copy_times(source: Path, target: Path, count: int, repeated: bool) -> None:
    values = np.load(source, mmap_mode="r")
    shape = (count + repeated, *values.shape[1:])
    part = np.lib.format.open_memmap(target, "w+", values.dtype, shape)
    part[:count] = values[:count]
    if repeated:
        part[count] = values[count - 1]
    part.flush()


def format_toml(table: dict[str, Any]) -> str:
    """Format the table of a run.toml: values first, then tables of values."""
    lines = [f"{_key(key)} = {_value(each)}" for key, each in table.items() if not isinstance(each, dict)]
    for name, inner in table.items():
        if isinstance(inner, dict):
            lines += [
                "",
                f"[{_key(name)}]",
                *(f"{_key(key)} = {_value(each)}" for key, each in inner.items()),
            ]
    return "\n".join(lines) + "\n"


def _key(text: str) -> str:
    return text if text.replace("_", "").replace("-", "").isalnum() and text.isascii() else json.dumps(text)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (datetime, date)):
        return value.isoformat()
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, dict):
        inner = ", ".join(f"{_key(key)} = {_value(each)}" for key, each in value.items())
        return f"{{ {inner} }}"
    return repr(value)
