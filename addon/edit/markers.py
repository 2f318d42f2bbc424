"""Markers of an edit: events of the run that the film shows."""

from __future__ import annotations

from collections.abc import Iterator

from ..cuts.cut import Marker
from ..escaped import escaped
from ..run import labels, times
from ..shot.shot import Shot
from ..stations import events, reading
from ..stations.events import Event, Place

IGNITION, FLARE_UP, ARRIVAL = "RED", "MAGENTA", "YELLOW"
"""Colours that OTIO and the locators of EDL files both have."""


def find(shot: Shot) -> list[Marker]:
    """Find ignition, flare-ups, and arrivals at towns and stations in the frames of a shot."""
    shown, markers = shot.frames, []
    for colour, event in _events(shot):
        seconds = times.seconds(shot.run, event.time)
        if shown.step > 0.0 and shown.first <= seconds <= shown.last:
            frame = 1 + round((seconds - shown.first) / shown.step)
            markers.append(Marker(frame, escaped(event.words), colour))
    return sorted(markers, key=lambda each: (each.frame, each.words))


def _events(shot: Shot) -> Iterator[tuple[str, Event]]:
    """Return events of the run with the colour of their markers."""
    run, settings = shot.run, shot.settings
    yield from ((IGNITION, each) for each in events.ignitions(run))
    yield from ((FLARE_UP, each) for each in events.flare_ups(run))
    places: list[Place] = [*labels.find(run, settings.labels.file)]
    if settings.stations.enabled and settings.stations.file is not None:
        places += reading.read(settings.stations.file).stations
    yield from ((ARRIVAL, each) for each in events.arrivals_at(run, places))
