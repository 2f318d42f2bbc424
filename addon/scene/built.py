"""Facts about a built scene for panels, stored with it: times of its frames, landmarks, size of the run."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields

import numpy as np

from ..blender.owned import Stage
from ..run import areas
from ..shot.shot import Shot
from ..shot.stations.station_signs import MovingPoints

_FACTS = "firetwin_facts"
_KNOTS = 49  # stored positions of the head, interpolated linearly


@dataclass(frozen=True)
class Facts:
    """Facts about a built scene.

    Attributes
    ----------
    first_time
        Model time of frame 1, ISO 8601.
    seconds_per_frame
        Model time between frames, s.
    frames
        Number of frames.
    zone
        Time zone of the clock; empty: the zone of the run.
    extent, height
        Width of the run, and mean height of its ground, m.
    landmarks
        Ignition, and head of the fire at some frames, as JSON; empty: unknown.
    """

    first_time: str
    seconds_per_frame: float
    frames: int
    zone: str
    extent: float
    height: float
    landmarks: str = ""


def gather(shot: Shot, landmarks: str) -> Facts:
    """Return the facts about the scene of a shot."""
    run, frames = shot.run, shot.frames
    dx, dy = areas.spacing(run.latitude, run.longitude)
    return Facts(
        shot.utc(1).isoformat(),
        frames.step,
        frames.count,
        shot.settings.time.zone,
        max(dx * len(run.longitude), dy * len(run.latitude)),
        float(np.nanmean(run.elevation)),
        landmarks,
    )


def landmarks_text(found: MovingPoints) -> str:
    """Write the ignition and positions of the head as JSON."""
    frames = np.unique(np.linspace(0, len(found.head) - 1, _KNOTS).round().astype(int))
    ignition = None if found.ignition is None else np.round(found.ignition, 1).tolist()
    head = np.round(found.head[frames], 1).tolist()
    return json.dumps({"ignition": ignition, "frames": (frames + 1).tolist(), "head": head})


def store(stage: Stage, facts: Facts) -> None:
    """Store the facts with the scene."""
    stage.root[_FACTS] = asdict(facts)


def read(stage: Stage) -> Facts | None:
    """Return the stored facts; None if an earlier version built the scene."""
    stored = stage.root.get(_FACTS)
    if stored is None:
        return None
    return Facts(**{name: value for name, value in stored.items() if name in NAMES})


def clear(stage: Stage) -> None:
    """Delete the stored facts, because nothing is built."""
    stage.root.pop(_FACTS, None)


NAMES = tuple(part.name for part in fields(Facts))
"""Names of the facts, which are properties of the panel too."""
