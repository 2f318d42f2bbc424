"""Forecast pass: the visible picture of one member, and how many members have burned the ground by now.

Ground that members have burned has one of at most five colours, by their number. Lines are the fronts of
other members at the same time; the outlier, the smallest and the largest have labels. Both follow the
ground below each pixel, from depth, with the fronts of the scores, so hills hide them. They fade under
smoke as the ground itself does, and flames stay in front (see `comp`). Hatched ground was not simulated by
all members that reach this time. Places have names, and the number of members that have burned them.
Captions name the member, the fire model, and the issue and valid times. Colours do not depend on the time
or on the member.
"""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ...imaging import split_screen
from ...shot import picture_credits
from ...shot.passes import DerivedPass, Files
from ...shot.shot import Shot
from .. import forecast
from . import ASPECTS, CODE, REQUIRES, _ground, _text

ORDER = 76
HELP = "Visible picture of one member, with fronts of others, and ground tinted by the members that burned"

PASS = DerivedPass(
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=ASPECTS | {"terrain"},
    code=CODE,
    requires=REQUIRES,
    needs=("rgb", "depth", "comp"),
)


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Draw the forecast."""
    shown = forecast.member_of(shot.settings, shot.run, first="@" not in camera)
    ground = _ground.draw(needed, shot, camera, frame, shown)
    height, width = ground.rgb.shape[:2]
    keys = _text.legend(shot, ground.counts)
    said = _text.caption(shot, ground.counts)
    below = picture_credits.foot(shot, width, height)
    sensor.write_image(
        files["png"], split_screen.sheet([ground.rgb], [keys], said, below, marks=[ground.marks])
    )
