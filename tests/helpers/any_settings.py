"""Hypothesis strategies for any valid settings of the schema."""

import typing
from datetime import UTC, datetime
from pathlib import Path

from firetwin import timecode
from firetwin.shot import schema
from firetwin.shot.schema.frame_list import FrameList
from hypothesis import strategies as st

SCENES = Path(Path.cwd().anchor, "scenes")
ZONES = ["America/Los_Angeles", "UTC", "Asia/Kathmandu"]
FOLDERS = st.sampled_from(
    ['a "quoted" one', "b\\c", "é/d", "../up", "/root of all", "~x", "tab\tdel\x7f", "."]
)
SPECIAL = {
    "zone": st.sampled_from(ZONES),
    "name": st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_-]{0,5}", fullmatch=True),
    "frames": st.sampled_from(["", "1", " 1 ,1-1:3"]),
    "photo_extent": st.sampled_from([(), (-121.0, 38.5, -120.0, 39.25)]),
    "resolution": st.tuples(*2 * [st.integers(8, 8192).map(lambda half: 2 * half)]),
}


def any_value(part):
    key, kind = part.key, part.type
    if kind is not int and part.name in SPECIAL:
        return SPECIAL[part.name]
    if key.variants:
        return st.one_of(*(any_table(rig) for rig in key.variants().values()))
    if part.name == "keys":
        at = st.lists(st.floats(0, 1), unique=True, min_size=1, max_size=3).map(sorted)
        return at.flatmap(lambda at: st.tuples(*(any_table(part.table, at=st.just(a)) for a in at)))
    if part.name == "stops":
        place = any_table(part.table, latitude=st.floats(-90, 90), longitude=st.floats(-180, 180))
        return st.lists(place, min_size=1, max_size=3).map(tuple)
    if part.tables:
        return st.lists(any_table(part.table), max_size=3, unique_by=lambda t: t.name).map(tuple)
    if part.table:
        return any_table(part.table)
    if typing.get_origin(kind) is tuple:
        known = list(key.names()) or ["a.3tz", "https://example.org/tileset.json", 'a "quoted" one']
        names = st.lists(st.sampled_from(known), unique=True, min_size=len(part.default) > 0)
        return names.map(tuple)
    if key.check is timecode.invalid_rate:
        return st.sampled_from([1, 12.0, 23.976, 25.0, 29.97, 59.94, 240.0])
    simple = {
        bool: st.booleans(),
        str: st.sampled_from(list(key.names()) or [""]),
        FrameList: st.just(FrameList()),
        Path: FOLDERS.map(lambda folder: SCENES / folder),
        datetime: st.datetimes(datetime(1001, 1, 1), datetime(9997, 1, 1), timezones=st.just(UTC)),
        int: st.integers(-(2**63) if key.at_least is None else key.at_least, key.at_most or 2**63 - 1),
        float: st.floats(
            key.above if key.at_least is None else key.at_least,
            key.at_most,
            exclude_min=key.above is not None,
            allow_nan=False,
            allow_infinity=False,
        ),
    }[kind]
    return st.none() | simple if part.default is None else simple


def any_table(kind, **known):
    tables = st.builds(kind, **{part.name: any_value(part) for part in schema.fields(kind)} | known)
    return tables.filter(lambda table: not schema.validate(table))
