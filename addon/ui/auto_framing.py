"""Automatic framing: time window and cameras that fit the run, until the user changes them."""

from __future__ import annotations

import functools
import json
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from ..blender import owned, stored_json
from ..shot.schema import fields, plain
from ..shot.sections import Time
from ..shot.settings import Settings
from . import camera_list, keys
from .job import InThread, Steps

if TYPE_CHECKING:
    from firetwin_core.run import Run

_WINDOW = ("start", "end")


def frame_run(run: Run, time: Time | None = None) -> dict[str, Any]:
    """Return the framing of a run, as JSON: cameras, values of [time], and messages about both.

    Parameters
    ----------
    time
        Time window of the shot; by default the run's most active period.
    """
    from ..run import content

    stamps = content.fingerprint({"files": content.stamps(run), "start": run.start})
    return _frame_folder(run.path, stamps, time or Time())


@functools.lru_cache(maxsize=8)
def _frame_folder(folder: str, stamps: str, time: Time) -> dict[str, Any]:
    """Return the framing of the run in a folder, in its current state."""
    from .. import auto_framing
    from ..run import readers

    run = readers.open(folder)
    fits = auto_framing.fit(run, Settings(run=Path(folder), time=time))
    values = {part.name: plain(part.type, getattr(fits.settings.time, part.name)) for part in fields(Time)}
    return {"cameras": camera_list.to_text(fits.settings.cameras), "time": values, "lines": fits.lines}


def apply_framing(panel: bpy.types.PropertyGroup, fits: dict[str, Any]) -> None:
    """Apply the framing of the panel's run to values that are defaults or come from an earlier framing."""
    before = _automatic_framing(panel)
    here = camera_list.to_text(camera_list.cameras(panel))
    if not panel.scene_file:
        _update_time(panel.time, before.get("time", {}), fits["time"])
    if here in ("", before.get("cameras", "")):
        if not here and not panel.scene_file:
            from ..smoke import sources

            panel.smoke.method = sources.find_preview()  # a slower method is announced first
        camera_list.fill(panel, camera_list.from_text(fits["cameras"]))
    panel.usual = json.dumps(fits | {"placed_for": [fits["time"][name] for name in _WINDOW]})


def reframe(uid: int) -> Steps:
    """Place automatic cameras again after the user changed the time window."""
    from ..run import readers, times

    panel = owned.scene(uid).firetwin
    usual, time = _automatic_framing(panel), _time_settings(panel)
    window = [plain(datetime, moment) for moment in (time.start, time.end)]
    here = camera_list.to_text(camera_list.cameras(panel))
    if panel.scene_file or here != usual.get("cameras") or window == usual["placed_for"]:
        return ""
    run = readers.open(bpy.path.abspath(panel.run))
    first, last = (times.utc(run, float(run.times[i])) for i in (0, -1))
    if time.validate() or any(moment and not first <= moment <= last for moment in (time.start, time.end)):
        return ""  # the next reader of the settings reports it
    fits = yield InThread("placing the cameras", lambda **_: frame_run(run, time))
    panel = owned.scene(uid).firetwin
    camera_list.fill(panel, camera_list.from_text(fits["cameras"]))
    kept = {"cameras": fits["cameras"], "lines": fits["lines"], "placed_for": window}
    panel.usual = json.dumps(usual | kept)
    return ""


def framing_messages(panel: bpy.types.PropertyGroup) -> list[str]:
    """Return messages about the framing, while its cameras are the panel's."""
    told, names = _parse_messages(panel.usual)
    return told if [item.name for item in panel.cameras] == names else []


@functools.lru_cache(maxsize=8)
def _parse_messages(usual: str) -> tuple[list[str], list[str]]:
    """Return messages, and names of the cameras, cached for drawing."""
    kept = stored_json.table(usual)
    return kept.get("lines", []), [each.name for each in camera_list.from_text(kept.get("cameras", ""))]


def _automatic_framing(panel: bpy.types.PropertyGroup) -> dict[str, Any]:
    return stored_json.table(panel.usual)


def _time_settings(panel: bpy.types.PropertyGroup) -> Time:
    return Time(**{part.name: keys.take(panel.time, part) for part in fields(Time)})


def _update_time(group: bpy.types.PropertyGroup, before: dict[str, Any], now: dict[str, Any]) -> None:
    """Update keys of [time] that are defaults, or come from the earlier framing, to the new framing."""
    for part in fields(Time):
        if not keys.is_changed(group, part) or keys.is_showing(
            group, part, _parse_time_values(before)[part.name]
        ):
            keys.put(group, part, _parse_time_values(now)[part.name])


def _parse_time_values(kept: dict[str, Any]) -> dict[str, Any]:
    """Return values of [time] from their JSON, with defaults for missing keys."""
    moments = {name: datetime.fromisoformat(kept[name]) for name in _WINDOW if kept.get(name)}
    return asdict(Time()) | kept | moments
