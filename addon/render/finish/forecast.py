"""Tint the ground by members of a forecast, and draw their fronts (see `shot.passes.forecast`)."""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ...imaging import split_screen
from ...shot import forecast, picture_credits
from ...shot.shot import Shot
from . import Files, _forecast_ground, _forecast_text


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Draw the forecast."""
    shown = forecast.member_of(shot.settings, shot.run, first="@" not in camera)
    ground = _forecast_ground.draw(needed, shot, camera, frame, shown)
    height, width = ground.rgb.shape[:2]
    keys = _forecast_text.legend(shot, ground.counts)
    said = _forecast_text.caption(shot, ground.counts)
    below = picture_credits.foot(shot, width, height)
    sensor.write_image(
        files["png"], split_screen.sheet([ground.rgb], [keys], said, below, marks=[ground.marks])
    )
