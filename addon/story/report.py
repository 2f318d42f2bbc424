"""Report of a story: each number of its captions with its model time and source."""

from __future__ import annotations

import json
from collections.abc import Sequence

from firetwin_core.run import Run

from ..run import citations, info, times
from .captions import Caption
from .storyboard import Storyboard

_FIELDS = {
    "fuel_arrival_time": "arrival times of the run at its fuel cells",
    "heat_flux": "heat fluxes of the run, from which the burned share of cells is estimated",
}


def area_source(run: Run) -> str:
    """Describe the field of a run from which areas are computed."""
    field = info.burned_from(run)
    return _FIELDS.get(field, f"{field} of the run")


def text(story: Storyboard, captions: Sequence[Caption], run: Run) -> str:
    """Write the report as JSON: sources, shots with their reasons, omitted shots, and numbers of captions."""
    content = {
        "run": run.name,
        "synthetic": bool(run.synthetic),
        "sources": citations.of_run(run),
        "area": {"field": info.burned_from(run), "from": area_source(run), "unit": "m2"},
        "shots": [
            {"name": shot.name, "reason": shot.reason, "speed": round(shot.speed, 3), "seconds": shot.seconds}
            for shot in story.shots
        ],
        "omitted": [{"name": each.name, "reason": each.reason} for each in story.omitted],
        "captions": [
            {
                "shot": each.span.shot.name,
                "from_s": round((each.first - 1) / story.fps, 3),
                "to_s": round((each.end - 1) / story.fps, 3),
                "time": times.iso(each.moment),
                "burned_area_m2": round(each.area, 1),
                "growth_m2_per_h": round(each.growth, 1),
                "text": each.text,
            }
            for each in captions
            if each.moment
        ],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"
