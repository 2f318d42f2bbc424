"""Time panel: model times of the frames, and the current time."""

from __future__ import annotations

import functools
import zoneinfo
from datetime import UTC, datetime, timedelta

import bpy

from .. import timecode
from ..run import times
from ..shot.schema import fields
from ..shot.sections import Time
from . import job, keys, panel_state, rows, run, working
from .sidebar import SidebarPanel
from .text import labelled_row


def position(settings: bpy.types.PropertyGroup) -> float:
    """Return the position of the current frame between the first (0) and the last (1)."""
    frame = settings.id_data.frame_current
    return min(max((frame - 1) / max(settings.frames - 1, 1), 0.0), 1.0)


def go_to(settings: bpy.types.PropertyGroup, value: float) -> None:
    """Go to the frame nearest to a position."""
    settings.id_data.frame_current = 1 + round(value * max(settings.frames - 1, 0))


def shown_time(settings: bpy.types.PropertyGroup) -> datetime:
    """Return the time of the current frame, UTC."""
    frame = settings.id_data.frame_current
    return datetime.fromisoformat(settings.first_time) + timedelta(
        seconds=(frame - 1) * settings.seconds_per_frame
    )


class FIRETWIN_OT_jump(bpy.types.Operator):
    """Show the frame nearest to this time"""

    bl_idname = "firetwin.jump"
    bl_label = "Jump to time of the run"
    bl_options = {"INTERNAL"}

    moment: bpy.props.StringProperty(options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.require(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = context.scene.firetwin
        frame = frame_at(settings, datetime.fromisoformat(self.moment))
        if not 1 <= round(frame) <= settings.frames:
            self.report({"WARNING"}, "No frame shows that time; widen Start and End, then rebuild the scene")
        context.scene.frame_current = min(max(round(frame), 1), settings.frames)
        return {"FINISHED"}


class FIRETWIN_OT_window(working.Editable, bpy.types.Operator):
    """Set the first or last frame to this time of the run"""

    bl_idname = "firetwin.window"
    bl_label = "Set time of first or last frame"
    bl_options = {"UNDO", "INTERNAL"}

    moment: bpy.props.StringProperty(options={"SKIP_SAVE"})
    key: bpy.props.StringProperty(options={"SKIP_SAVE"})

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        part = next(part for part in fields(Time) if part.name == self.key)
        keys.put(context.scene.firetwin.time, part, datetime.fromisoformat(self.moment).astimezone(UTC))
        return {"FINISHED"}


def frame_at(settings: bpy.types.PropertyGroup, moment: datetime) -> float:
    """Return the frame of a time, which may be before the first or after the last frame."""
    since = (moment - datetime.fromisoformat(settings.first_time)).total_seconds()
    return 1 + since / (settings.seconds_per_frame or 1.0)


def dated_events(settings: bpy.types.PropertyGroup) -> list[list[str]]:
    """Return dated events of the run: ISO text and description of each."""
    return run.parse_facts(settings.facts)["moments"]


class FIRETWIN_MT_moments(bpy.types.Menu):
    """Dated events of the run"""

    bl_idname = "FIRETWIN_MT_moments"
    bl_label = "Jump to Event"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.firetwin
        for moment, words in dated_events(settings):
            text = f"{_format_local(datetime.fromisoformat(moment), _time_zone(settings))}, {words}"
            self.layout.operator(FIRETWIN_OT_jump.bl_idname, text=text).moment = moment


class FIRETWIN_MT_start(bpy.types.Menu):
    """Set the first frame to a dated event of the run"""

    bl_idname = "FIRETWIN_MT_start"
    bl_label = "Begin at Event"

    def draw(self, context: bpy.types.Context) -> None:
        _draw_event_buttons(self.layout, context.scene.firetwin, "start")


class FIRETWIN_MT_end(bpy.types.Menu):
    """Set the last frame to a dated event of the run"""

    bl_idname = "FIRETWIN_MT_end"
    bl_label = "End at Event"

    def draw(self, context: bpy.types.Context) -> None:
        _draw_event_buttons(self.layout, context.scene.firetwin, "end")


def _draw_event_buttons(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, key: str) -> None:
    """Draw dated events as buttons that set the start or end of the time window."""
    for moment, words in dated_events(settings):
        text = f"{_format_local(datetime.fromisoformat(moment), _time_zone(settings))}, {words}"
        button = layout.operator(FIRETWIN_OT_window.bl_idname, text=text)
        button.moment, button.key = moment, key


def _time_zone(settings: bpy.types.PropertyGroup) -> str:
    """Return the time zone of the clock: from the settings, else the run's."""
    return settings.time.zone or run.parse_facts(settings.facts)["zone"]


def _format_local(moment: datetime, zone: str) -> str:
    try:
        return times.text(moment, zone)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):  # incompletely typed
        return f"{moment.day} {moment:%b %Y %H:%M} UTC"


@functools.lru_cache(maxsize=32)
def _window_end(text: str, other: str) -> datetime | None:
    """Return start or end of the time window: the typed time, else the run's; None without either."""
    try:
        moment = datetime.fromisoformat((text or other).strip())
    except ValueError:
        return None
    return moment if moment.tzinfo else moment.replace(tzinfo=UTC)


class FIRETWIN_PT_time(SidebarPanel, bpy.types.Panel):
    """Model times of the frames, and the time that is shown"""

    bl_idname = "FIRETWIN_PT_time"
    bl_label = "Time"
    bl_order = 2

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.firetwin, self.layout
        if panel_state.is_built(context.scene):
            _draw_clock(layout, settings)
        facts = run.parse_facts(settings.facts)
        ends = []
        for name, other, menu in (("start", "first", FIRETWIN_MT_start), ("end", "last", FIRETWIN_MT_end)):
            moment = _window_end(getattr(settings.time, name), facts[other])
            ends.append(moment)
            column = layout.column(align=True)
            column.enabled = job.Job.current is None
            typed = bool(getattr(settings.time, name))
            told = (
                _format_local(moment, _time_zone(settings))
                if moment
                else "not a date and time"
                if typed
                else ""
            )
            column.label(text=f"{keys.label(name)}: {told}" if told else keys.label(name))
            row = column.row(align=True)
            row.prop(settings.time, name, text="", placeholder=f"The run's {other} (UTC)")
            row.menu(menu.bl_idname, text="", icon="DOWNARROW_HLT")
        for part in fields(Time):
            if part.name not in ("start", "end"):
                rows.draw_key(layout, settings.time, part, "time")
        _draw_speed(layout, settings.time, *ends)


def _draw_speed(
    layout: bpy.types.UILayout, time: bpy.types.PropertyGroup, first: datetime | None, last: datetime | None
) -> None:
    """Draw the speed of the films: as given, else by start and end."""
    given, fps = (
        next(keys.take(time, part) for part in fields(Time) if part.name == name) for name in ("speed", "fps")
    )
    rate = float(timecode.exact_rate(fps))
    if given is not None:
        step = given / rate
    elif first and last and time.frames > 1:
        step = (last - first).total_seconds() / (time.frames - 1)
    else:
        return
    layout.label(text=f"{step:,.7g} s per frame, {step * rate:,.4g} times real time")


def _draw_clock(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """Draw the current time, local and UTC, with buttons to go to other times."""
    now = shown_time(settings)
    local = times.text(now, settings.zone)
    layout.prop(settings, "model_time", text=local.split(maxsplit=3)[-1], slider=True)
    column = layout.column(align=True)
    for label, text in (
        ("Local", local),
        ("UTC", f"{now.day} {now:%b %Y %H:%M}"),
        ("Frame", f"{settings.id_data.frame_current} of {settings.frames}"),
    ):
        labelled_row(column, label).label(text=text)
    layout.menu(FIRETWIN_MT_moments.bl_idname)


classes = (
    FIRETWIN_OT_jump,
    FIRETWIN_OT_window,
    FIRETWIN_MT_moments,
    FIRETWIN_MT_start,
    FIRETWIN_MT_end,
    FIRETWIN_PT_time,
)
