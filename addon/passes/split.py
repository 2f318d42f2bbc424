"""Split screen pass: all runs' visible pictures at one time, with names, burned area and front colours.

Two runs have a half each, with the central half of their pictures: the same landscape in both. Three or four
have a quarter each, with the complete picture at half size.
"""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ..imaging import split_screen
from ..run import info, times
from ..shot import comparison, picture_credits
from ..shot.passes import ComparisonPass, Files, view_of
from ..shot.shot import Shot
from ..shot.surface import fronts

ORDER = 70
HELP = "Split screen: the pictures of all [[runs]] side by side, with names and time"

PASS = ComparisonPass(
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "picture"}),
    needs_of_all=("rgb",),
)


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Compose the pictures."""
    moment, colours, drawn = shot.utc(frame), fronts.colours(shot), shot.settings.fire.fronts
    names = ["rgb", *(view_of("rgb", label) for label in shot.others)]
    pictures = [sensor.read_image(needed[name]["png"])[..., :3] for name in names]
    keys = []
    for label, run in {shot.label: shot.run, **shot.others}.items():
        acres = info.burned(run, [times.seconds(run, moment)])[0] / info.ACRE
        others = [(colours[other], f"front of {other}") for other in colours if other != label]
        keys.append([(colours[label], f"{label}  {acres:,.0f} acres"), *(others if drawn else ())])
    said = comparison.caption(shot, frame)
    height, width = pictures[0].shape[:2]
    below = picture_credits.foot(shot, width, height, compares=True)
    sensor.write_image(files["png"], split_screen.sheet(pictures, keys, said, below))
