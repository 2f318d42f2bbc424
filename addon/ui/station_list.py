"""Stations that the panel lists: rows in the window's data, which a timer makes and panels only draw.

`scene.firetwin.station` names the selected station by its number and name in the file. Lists, the map and the
handles in the 3D view all show that one. What is listed is no part of the .blend file.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from ..errors import Error
from ..progress import count
from ..stations import fire_arrival, listing
from ..stations.listing import Row
from ..stations.query import Query
from ..stations.records import Station
from . import station_data, station_filter
from .station_data import Key, Loaded

NO_FILE = "Choose a file of stations above"
READING = "Reading the stations"


class FIRETWIN_PG_station(bpy.types.PropertyGroup):
    """A station of the list"""

    kind: bpy.props.StringProperty()
    minutes: bpy.props.StringProperty()
    exercise: bpy.props.BoolProperty()


class FIRETWIN_PG_stations(bpy.types.PropertyGroup):
    """Stations that are listed in this session"""

    rows: bpy.props.CollectionProperty(type=FIRETWIN_PG_station)
    stamp: bpy.props.IntProperty()


@dataclass(frozen=True)
class Shown:
    """What is listed, and of what; `stamp` is another one after each change."""

    wanted: Key | None = None
    query: Query | None = None
    loaded: Loaded | None = None
    rows: list[Row] = field(default_factory=list)
    place: dict[str, int] = field(default_factory=dict)
    told: str = NO_FILE
    stamp: int = 0


@dataclass(frozen=True)
class Detail:
    """What is known of the selected station: its lines, and the fire's arrival."""

    station: Station
    lines: list[tuple[str, str]]


_shown = Shown()
_detail: tuple[tuple[str, int] | None, Detail | None] = (None, None)


def shown() -> Shown:
    """What is listed."""
    return _shown


def detail(panel: bpy.types.PropertyGroup) -> Detail | None:
    """What is known of the selected station, once `describe` has found it."""
    known, found = _detail
    return found if known is not None and known[0] == panel.station else None


def refresh(panel: bpy.types.PropertyGroup) -> bool:
    """Bring the list up to date; returns whether something is still being read."""
    wanted = station_data.key(panel)
    found = None if wanted is None else station_data.get(wanted)
    if wanted is None or not isinstance(found, Loaded):
        told = NO_FILE if wanted is None else READING if found is None else str(found)
        _put(Shown(wanted, told=told))
        return wanted is not None and found is None
    try:
        asked = station_filter.query(panel, found)
        if (wanted, asked) != (_shown.wanted, _shown.query):
            _put(_survey(wanted, found, asked))
        else:
            _put(_shown)
    except Error as error:
        _put(Shown(wanted, None, found, told=str(error)))
    describe(panel)
    return False


def describe(panel: bpy.types.PropertyGroup) -> None:
    """Find out what is known of the selected station."""
    global _detail
    loaded, now = _shown.loaded, (panel.station, id(_shown.loaded))
    if _detail[0] == now:
        return
    station = None if loaded is None else listing.find(loaded.station_file.stations, panel.station)
    if loaded is None or station is None:
        _detail = now, None
        return
    lines = listing.facts(loaded.station_file, station)
    if loaded.run is not None and loaded.arrivals is not None:
        reached = fire_arrival.text(loaded.run, loaded.arrivals, loaded.station_file.station_row[station.id])
        marked = not lines[-1][0]  # that it is an exercise stands last
        lines.insert(len(lines) - marked, ("Fire", reached))
    _detail = now, Detail(station, lines)


def place(panel: bpy.types.PropertyGroup) -> int:
    """Index of the selected station in the list; -1 where it is not listed."""
    return _shown.place.get(panel.station, -1)


def forget() -> None:
    """Nothing is listed."""
    global _shown, _detail
    _shown, _detail = Shown(), (None, None)
    station_data.forget()


def _survey(wanted: Key, loaded: Loaded, asked: Query) -> Shown:
    found = listing.survey(loaded.station_file, asked)
    told = count(len(found.rows), "station")
    out = ", ".join(f"{number:,} {reason}" for reason, number in found.left_out.items())
    told += f"; left out: {out}" if out else ""
    told += f". {loaded.problem}" if loaded.problem else ""
    places = {listing.key(each.station): k for k, each in enumerate(found.rows)}
    return Shown(wanted, asked, loaded, found.rows, places, told)


def _put(now: Shown) -> None:
    """List it, where it is not listed already."""
    global _shown
    held = bpy.context.window_manager.firetwin_stations
    same = (now.wanted, now.query, now.told) == (_shown.wanted, _shown.query, _shown.told)
    if same and held.stamp == _shown.stamp and len(held.rows) == len(_shown.rows):
        return
    values = {name: getattr(now, name) for name in ("wanted", "query", "loaded", "rows", "place", "told")}
    _shown = Shown(**values, stamp=_shown.stamp + 1)
    held.stamp = _shown.stamp
    held.rows.clear()
    for each in _shown.rows:
        row = held.rows.add()
        row.name, row.kind, row.exercise = each.station.name, each.station.kind, each.exercise
        row.minutes = "" if each.minutes is None else f"{each.minutes:.0f} min"


classes = (FIRETWIN_PG_station, FIRETWIN_PG_stations)
