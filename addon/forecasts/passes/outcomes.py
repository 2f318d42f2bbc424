"""Outcomes pass: the forecast pictures of all runs in turn, with hard cuts, as one film.

Each run is a member of the forecast. Its pictures are shown for 1.5 s, then the pictures of the next one,
at the running clock of the film; after the last comes the first. The bar at the top has a part for each
run, and the shown one is white; a counter names the member, its roles, and the area that it has burned. A
film of nearly one moment (`time.start` and `time.end` a minute apart) compares outcomes at this moment.
Draws of 0.4 s could be followed in studies, and 0.1 s were too short (Kale et al., 2019).
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...imaging import split_screen
from ...run import info, times
from ...shot.passes import ComparisonPass, Files, view_of
from ...shot.shot import Shot
from .. import forecast
from . import ASPECTS, CODE, REQUIRES, _text

ORDER = 77
HELP = "Forecast pictures of all [[runs]] in turn, 1.5 s each, with hard cuts"

PASS = ComparisonPass(
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=ASPECTS,
    code=CODE,
    requires=REQUIRES,
    needs=("forecast",),
    needs_of_all=("forecast",),
)

SECONDS = Fraction(3, 2)
"""Time of one run on the screen, s."""
_BAR = 60  # height of the picture / height of the bar
_OTHER = 0.25  # grey level of the parts of the bar that are not shown


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, _camera: str, frame: int) -> None:
    """Choose the picture of a frame, and draw the bar and the counter."""
    runs = {"": shot.run, **shot.others}
    which = turn(frame, shot.settings.time.rate, len(runs))
    label, run = list(runs.items())[which]
    picture = sensor.read_image(needed[view_of("forecast", label) if label else "forecast"]["png"])[..., :3]
    ensemble = forecast.of(shot.settings)
    shown = forecast.member_of(shot.settings, run, first=not label)
    counter = [f"outcome {which + 1} of {len(runs)} shown", *_text.member(ensemble, shown)]
    area = float(info.burned(run, [times.seconds(run, shot.utc(frame))])[0])
    counter.append(_text.burned(area))
    barred = with_bar(picture, which, len(runs))
    sensor.write_image(files["png"], split_screen.sheet([barred], [[]], [], corner=counter))


def turn(frame: int, rate: Fraction, runs: int) -> int:
    """Return the index of the run that a frame, from 1, shows at a frame rate (1/s)."""
    return (frame - 1) // max(round(SECONDS * rate), 1) % runs


def with_bar(picture: NDArray[np.float32], which: int, runs: int) -> NDArray[np.float32]:
    """Draw a bar at the top of a picture (h, w, 3): a part for each run, the shown one white."""
    bar = picture.copy()
    height, width = picture.shape[:2]
    rows, edges = max(height // _BAR, 2), np.linspace(0, width, runs + 1).round().astype(int)
    for run in range(runs):
        bar[:rows, edges[run] : edges[run + 1] - 2] = 1.0 if run == which else _OTHER
        bar[:rows, edges[run + 1] - 2 : edges[run + 1]] = 0.0
    return bar
