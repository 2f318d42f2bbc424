"""Station list of the panel: rows in the window manager, which a timer updates and panels draw.

`scene.firetwin.station` is the selected station, by number and name in the file; list, map and handles in the
3D view share it. The rows are not stored in the .blend file.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import bpy

from ..errors import Error
from ..progress import count
from ..run import zone
from ..stations import arrival_text, listing
from ..stations.listing import StationRow
from ..stations.query import Query
from ..stations.records import Station
from . import station_data, station_filter
from .station_data import Loaded, StationKey

NO_FILE = "Choose a station file above"
READING = "Reading the stations"


class FIRETWIN_PG_station(bpy.types.PropertyGroup):
    """Station of the list"""

    kind: bpy.props.StringProperty()
    minutes: bpy.props.StringProperty()
    exercise: bpy.props.BoolProperty()


class FIRETWIN_PG_stations(bpy.types.PropertyGroup):
    """Stations listed in this session"""

    rows: bpy.props.CollectionProperty(type=FIRETWIN_PG_station)
    stamp: bpy.props.IntProperty()


@dataclass(frozen=True)
class ListState:
    """Content of the list and its input; `stamp` changes with the content."""

    wanted: StationKey | None = None
    query: Query | None = None
    loaded: Loaded | None = None
    rows: list[StationRow] = field(default_factory=list)
    place: dict[str, int] = field(default_factory=dict)
    status: str = NO_FILE
    stamp: int = 0


@dataclass(frozen=True)
class Detail:
    """Details of the selected station, with the arrival of the fire."""

    station: Station
    lines: list[tuple[str, str]]


@dataclass
class _Session:
    """State of the list, and details of the station that was described last."""

    shown: ListState = field(default_factory=ListState)
    described: tuple[str, Loaded | None] | None = None
    detail: Detail | None = None


_session = _Session()


def shown() -> ListState:
    """Return the state of the list."""
    return _session.shown


def detail(panel: bpy.types.PropertyGroup) -> Detail | None:
    """Return the details of the selected station; None before `describe` has run."""
    described = _session.described
    return _session.detail if described is not None and described[0] == panel.station else None


def refresh(panel: bpy.types.PropertyGroup) -> bool:
    """Update the list; return True while files are still being read."""
    wanted = station_data.key(panel)
    loaded = None if wanted is None else station_data.get(wanted)
    if wanted is None or not isinstance(loaded, Loaded):
        status = NO_FILE if wanted is None else READING if loaded is None else str(loaded)
        _publish(ListState(wanted, status=status))
        return wanted is not None and loaded is None
    try:
        asked = station_filter.query(panel, loaded)
        same = (wanted, asked) == (shown().wanted, shown().query)
        _publish(shown() if same else _survey(wanted, loaded, asked))
    except Error as error:
        _publish(ListState(wanted, None, loaded, status=str(error)))
    describe(panel)
    return False


def describe(panel: bpy.types.PropertyGroup) -> None:
    """Collect the details of the selected station."""
    loaded, described = shown().loaded, _session.described
    if described is not None and described[0] == panel.station and described[1] is loaded:
        return
    _session.described, _session.detail = (panel.station, loaded), None
    station = None if loaded is None else listing.find(loaded.station_file.stations, panel.station)
    if loaded is None or station is None:
        return
    lines = listing.facts(loaded.station_file, station)
    if loaded.run is not None and loaded.arrivals is not None:
        row, clock = loaded.station_file.station_row[station.id], zone.time_zone(loaded.run)
        reached = str(arrival_text.describe(loaded.run, loaded.arrivals, row, clock))
        marked = not lines[-1][0]  # the label of an exercise comes last
        lines.insert(len(lines) - marked, ("Fire", reached))
    _session.detail = Detail(station, lines)


def place(panel: bpy.types.PropertyGroup) -> int:
    """Return the index of the selected station in the list; -1 if it is not listed."""
    return shown().place.get(panel.station, -1)


def clear() -> None:
    """Clear the list."""
    _session.shown, _session.described, _session.detail = ListState(), None, None
    station_data.clear()


def _survey(wanted: StationKey, loaded: Loaded, asked: Query) -> ListState:
    survey = listing.survey(loaded.station_file, asked)
    status = count(len(survey.rows), "station")
    out = ", ".join(f"{number:,} {reason}" for reason, number in survey.left_out.items())
    status += f"; left out: {out}" if out else ""
    status += f". {loaded.problem}" if loaded.problem else ""
    places = {listing.station_key(each.station): k for k, each in enumerate(survey.rows)}
    return ListState(wanted, asked, loaded, survey.rows, places, status)


def _publish(now: ListState) -> None:
    """Write the rows for the panel, if they have changed."""
    held, before = bpy.context.window_manager.firetwin_stations, shown()
    same = (now.wanted, now.query, now.status) == (before.wanted, before.query, before.status)
    if same and held.stamp == before.stamp and len(held.rows) == len(before.rows):
        return
    _session.shown = replace(now, stamp=before.stamp + 1)
    held.stamp = _session.shown.stamp
    held.rows.clear()
    for each in now.rows:
        row = held.rows.add()
        row.name, row.kind, row.exercise = each.station.name, each.station.kind, each.exercise
        row.minutes = "" if each.minutes is None else f"{each.minutes:.0f} min"


classes = (FIRETWIN_PG_station, FIRETWIN_PG_stations)
