"""The model time of the frame that is shown."""

from __future__ import annotations

from datetime import datetime, timedelta

import bpy

from ..run import times
from ..shot.shot import Shot
from .text import labelled


def position(settings: bpy.types.PropertyGroup) -> float:
    """Where between the first frame (0) and the last (1) the scene is."""
    frame = settings.id_data.frame_current
    return min(max((frame - 1) / max(settings.frames - 1, 1), 0.0), 1.0)


def go_to(settings: bpy.types.PropertyGroup, value: float) -> None:
    """Show the frame nearest to a position."""
    settings.id_data.frame_current = 1 + round(value * max(settings.frames - 1, 0))


def remember(settings: bpy.types.PropertyGroup, shot: Shot) -> None:
    """Keep how frames and model time belong together."""
    settings.first_time = shot.moment(1).isoformat()
    settings.seconds_per_frame = shot.frames.step
    settings.frames, settings.zone = shot.frames.count, shot.settings.time.zone


def forget(settings: bpy.types.PropertyGroup) -> None:
    """Nothing is built any more."""
    for name in ("first_time", "seconds_per_frame", "frames", "zone"):
        settings.property_unset(name)


def moment(settings: bpy.types.PropertyGroup) -> datetime:
    """Moment of the frame that is shown, UTC."""
    frame = settings.id_data.frame_current
    return datetime.fromisoformat(settings.first_time) + timedelta(
        seconds=(frame - 1) * settings.seconds_per_frame
    )


class FIRETWIN_PT_time(bpy.types.Panel):
    """The model time of the frame that is shown"""

    bl_idname = "FIRETWIN_PT_time"
    bl_label = "Model Time"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"
    bl_order = 2

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.scene.firetwin.first_time)

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.firetwin, self.layout
        now = moment(settings)
        local = times.text(now, settings.zone)
        layout.prop(settings, "model_time", text=local.split(maxsplit=3)[-1], slider=True)
        column = layout.column(align=True)
        for label, text in (
            ("Local", local),
            ("UTC", f"{now.day} {now:%b %Y %H:%M}"),
            ("Frame", f"{context.scene.frame_current} of {settings.frames}"),
        ):
            labelled(column, label).label(text=text)


classes = (FIRETWIN_PT_time,)
