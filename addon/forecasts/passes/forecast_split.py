"""Forecast split pass: the pictures of all runs side by side, with the ground tinted as in `forecast`.

Each run is a member of the forecast, such as the typical, the smallest, the largest and the outlier. Each
part names its member with its roles and the area that it has burned, and draws its front. Colours are the
same in all parts: the number of members that have burned the ground. `split` has no colours.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor

from ...imaging import split_screen
from ...imaging.split_screen import Key
from ...run import info, times
from ...shot import comparison, picture_credits
from ...shot.passes import ComparisonPass, Files, view_of
from ...shot.shot import Shot
from .. import forecast
from . import ASPECTS, CODE, REQUIRES, _ground, _text
from ._ground import Ground

ORDER = 78
HELP = "Split screen of all [[runs]], with the ground tinted by the members that burned"

PASS = ComparisonPass(
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=ASPECTS | {"terrain"},
    code=CODE,
    requires=REQUIRES,
    needs=("rgb", "depth", "comp"),
    needs_of_all=("rgb", "depth", "comp"),
)

_EMPTY = 0.25  # grey level behind the legend: as bright as the ground


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Compose the pictures."""
    moment, grounds, keys = shot.utc(frame), list[Ground](), list[list[Key]]()
    for label, run in {"": shot.run, **shot.others}.items():
        own = {name: needed[view_of(name, label) if label else name] for name in ("rgb", "depth", "comp")}
        shown = forecast.member_of(shot.settings, run, first=not label)
        grounds.append(_ground.draw(own, shot, camera, frame, shown, others=False))
        area = float(info.burned(run, [times.seconds(run, moment)])[0])
        keys.append(_text.part(grounds[-1].counts, area))
    pictures, marks = [ground.rgb for ground in grounds], [ground.marks for ground in grounds]
    legend = _text.legend(shot, grounds[0].counts, len(grounds))
    if len(pictures) == 3:
        pictures.append(np.full_like(pictures[0], _EMPTY))
        keys.append(legend)
    else:
        keys[0] += legend
    said = [*comparison.caption(shot, frame)[:-1], *_text.when(shot, grounds[0].counts)]
    height, width = pictures[0].shape[:2]
    below = picture_credits.foot(shot, width, height, compares=True)
    sensor.write_image(files["png"], split_screen.sheet(pictures, keys, said, below, marks=marks))
