"""Dated events that Go to accepts: reports, start and end of the run, the fire's arrival at stations."""

from __future__ import annotations

from datetime import datetime

import bpy

from ..stations import events
from ..stations.events import Event
from . import run, station_data


def list_events(panel: bpy.types.PropertyGroup) -> list[Event]:
    """Return events of the run in order of time, with station events once a thread has read them."""
    moments = run.parse_facts(panel.facts)["moments"]
    found = [Event(datetime.fromisoformat(time), words) for time, words in moments]
    return sorted([*found, *_station_arrivals(panel)], key=lambda event: event.time)


def find_event(panel: bpy.types.PropertyGroup, text: str) -> Event | None:
    """Return the event with this text, or the first whose text contains it."""
    wanted = text.strip().lower()
    matches = [event for event in list_events(panel) if wanted and wanted in event.words.lower()]
    return min(matches, key=lambda event: event.words.lower() != wanted, default=None)


def _station_arrivals(panel: bpy.types.PropertyGroup) -> list[Event]:
    """Return the run's arrival times of the fire at stations."""
    key = station_data.key(panel)
    loaded = station_data.get(key) if key else None
    if not isinstance(loaded, station_data.Loaded) or loaded.run is None or loaded.arrivals is None:
        return []
    return events.arrivals(loaded.run, loaded.station_file.stations, loaded.arrivals)
