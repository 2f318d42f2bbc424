"""Filters of the station list: the conditions of `firetwin resources`, as properties and as a query."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from datetime import datetime

import bpy

from ..errors import Error
from ..run import times
from ..stations import arguments
from ..stations.query import Query
from ..stations.records import MODES
from . import keys, panel_state, station_data, station_sync, time
from .station_data import Loaded

NOWHERE, IGNITION, HEAD = "nowhere", "ignition", "head"
ANY = "any"
_MODES = ((ANY, "Any", "All modes"), *((each, keys.label(each), "") for each in MODES))


def changed(group: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Schedule an update of the list (update callback)."""
    station_sync.wake()


def _kinds(group: bpy.types.PropertyGroup, context: bpy.types.Context, text: str) -> Iterable[str]:
    return station_data.kinds()


class FIRETWIN_PG_stationfilter(bpy.types.PropertyGroup):
    """Which stations are listed"""

    kind: bpy.props.StringProperty(
        name="Kind",
        description="Kinds of resources, such as engine,dozer; empty: all",
        search=_kinds,
        search_options={"SUGGESTION"},
        update=changed,
    )
    types: bpy.props.StringProperty(
        name="Type", description="Types of resources, such as 3, 1-3 or VLAT; empty: all", update=changed
    )
    mode: bpy.props.EnumProperty(
        name="Mode",
        description="Operational mode of resources",
        items=_MODES,
        update=changed,
    )
    near: bpy.props.EnumProperty(
        name="Near",
        description="Destination for distances and minutes",
        items=(
            (NOWHERE, "Nowhere", "No distances and no minutes"),
            (IGNITION, "Ignition", "Ignition point of the run"),
            (HEAD, "Head", "Head of the fire at the current frame"),
        ),
        default=IGNITION,
        update=changed,
    )
    within: bpy.props.FloatProperty(
        name="Within", description="Maximum straight distance, km; 0: any", min=0.0, precision=1,
        update=changed,
    )  # fmt: skip
    minutes: bpy.props.FloatProperty(
        name="Minutes", description="Maximum time from the order to the arrival, min; 0: any", min=0.0,
        precision=0, update=changed,
    )  # fmt: skip
    available: bpy.props.BoolProperty(
        name="Available then",
        description="Only stations with a resource that is available at the time of the current frame",
        update=changed,
    )


def shown_time(panel: bpy.types.PropertyGroup) -> datetime | None:
    """Return the time of the current frame, UTC; None before a build."""
    return time.shown_time(panel) if panel_state.is_built(panel.id_data) else None


def query(panel: bpy.types.PropertyGroup, loaded: Loaded) -> Query:
    """Convert the filters of the panel to a query.

    Raises
    ------
    Error
        A list of types is invalid, or a filter needs missing data.
    """
    chosen, near = panel.station_filter, _near(panel, loaded)
    if chosen.available and not panel_state.is_built(panel.id_data):
        raise Error("Available then: build the scene first, so that a time is shown")
    try:
        types = arguments.parse_types(chosen.types) if chosen.types.strip() else ()
    except argparse.ArgumentTypeError as error:
        raise Error(f"Type {error}") from None
    return Query(
        near=near,
        within_km=chosen.within if chosen.within and near else None,
        minutes=chosen.minutes if chosen.minutes and near else None,
        kinds=tuple(part.strip().lower() for part in chosen.kind.split(",") if part.strip()),
        types=types,
        modes=() if chosen.mode == ANY else (chosen.mode,),
        at=shown_time(panel) if chosen.available else None,
    )


def _near(panel: bpy.types.PropertyGroup, loaded: Loaded) -> tuple[float, float] | None:
    """Return the destination; before a build the head is taken at the end of the run."""
    if panel.station_filter.near == HEAD and loaded.run is not None and loaded.head is not None:
        return loaded.head(shown_time(panel) or times.utc(loaded.run, float(loaded.run.times[-1])))
    return None if panel.station_filter.near == NOWHERE else loaded.ignition


def copy(source: bpy.types.PropertyGroup, target: bpy.types.PropertyGroup) -> None:
    """Copy all filters to another scene."""
    for name in FIRETWIN_PG_stationfilter.__annotations__:
        setattr(target, name, getattr(source, name))


classes = (FIRETWIN_PG_stationfilter,)
