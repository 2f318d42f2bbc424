"""Fuzzing of scene files: one or two keys set to any value give a scene, or one readable error line."""

import contextlib
import datetime
import io
import itertools
import json
import math
import typing
from pathlib import Path

import numpy as np
from firetwin import cli
from firetwin.render import plan
from firetwin.shot import schema
from firetwin.shot.cameras.rigs import kinds
from firetwin.shot.settings import Settings
from firetwin.shot.source import ShotSource
from hypothesis import strategies as st

PLACE = {"latitude": 38.843, "longitude": -120.546}
NUMBERS = (
    0,
    -0.0,
    1,
    -1,
    5e-324,
    1e-6,
    1e22,
    -1e22,
    1e308,
    math.inf,
    -math.inf,
    math.nan,
    2**63 - 1,
    -(2**63),
)
TEXTS = (
    *(
        "",
        " ",
        "a",
        "drone",
        "1-",
        "1-9:0",
        "9" * 400,
        "..",
        "../..",
        "~",
        "~nobody/x",
        "CON",
        "é",
        "\U0001f525",
    ),
    *(
        "\0",
        "a\0b",
        "\x1b[31mred\nnew",
        "\x9b31m",
        "\u202eabc",
        "\u2028",
        "%s{0}\\",
        "'\"",
        "x" * 400,
        "x/" * 3000,
    ),
    *(
        "run",
        "scene.toml",
        "run/run.toml",
        "run/heat_flux.npy",
        "/dev/null",
        "/proc/self/nothing",
        "UTC",
        "../UTC",
    ),
)
OTHERS = (True, [], [[]], {}, {"a": 1}, [1, "a"], 1.5, 3, [PLACE], datetime.date(2014, 9, 17))
MOMENTS = ("2014-09-17T21:06:00Z", "0001-01-01T00:00:00Z", "9999-12-31T23:59:59Z", "2014-09-17T21:00:00")


def run(folder):
    """Write a run of 3 x 3 cells whose fire burns two of them."""
    folder.mkdir()
    latitude, longitude = 38.84 + 0.003 * np.arange(3), -120.55 + 0.004 * np.arange(3)
    flux = np.zeros((3, 3, 3), np.float32)
    flux[1:, 1, 1], flux[2, 1, 2] = 3e4, 5e4
    fields = {"latitude": latitude, "longitude": longitude, "heat_flux": flux}
    fields |= {"fuel_latitude": latitude, "fuel_longitude": longitude}
    fields["elevation"] = (1200 + 10 * np.arange(9.0).reshape(3, 3)).astype(np.float32)
    fields |= dict.fromkeys(("surface_fuel", "canopy_fuel"), np.ones((3, 3), np.float32))
    for name, values in fields.items():
        np.save(folder / f"{name}.npy", values)
    (folder / "run.toml").write_text(
        'name = "Tiny"\nsynthetic = true\nstart = 2014-09-17T21:00:00Z\ninterval_s = 360.0\n'
        'vertical = "orthometric"\n[units]\nelevation = "m"\nheat_flux = "W/m2"\n'
        'surface_fuel = "kg/m2"\ncanopy_fuel = "kg/m2"\n'
    )


def plain(kind):
    """A small scene with a camera of this kind."""
    camera = {"name": "drone", "kind": kind}
    if kind in ("lookout", "orbit"):
        camera |= PLACE
    if kind in ("drone", "vr", "satellite", "poses"):
        camera["keys"] = [PLACE | {"height": 1700.0 if kind == "poses" else 400.0}]
    if kind in ("drone", "vr"):
        camera["keys"][0]["target"] = "fire"
    if kind == "tour":
        camera["stops"] = [PLACE | {"distance": 300.0}, {"place": "head"}]
    if kind == "lookout":
        camera["keys"] = [{"pan": 40.0}]
    cameras = [camera]
    if kind == "vr":
        camera["resolution"] = [64, 64]
    if kind in ("mounted", "minimap"):
        cameras = [*plain("drone")["cameras"], camera | {"name": "other", "follows": "drone"}]
    return {
        "run": "run",
        "time": {"frames": 2},
        "terrain": {"near_radius": 0.0, "apron": 2000.0},
        "forest": {"density": "paper"},
        "fire": {"firebrands": 0},
        "smoke": {"enabled": False},
        "render": {"resolution": [64, 36], "samples": 1, "passes": ["rgb"], "video": False},
        "cameras": cameras,
    }


def _places(kind, values, where=()):
    """Position of each key of a dataclass in nested tables, and the key; the last table of a list."""
    for part in schema.fields(kind):
        here = (*where, part.name)
        if part.key.variants:
            yield (*where, part.key.tag), part
            yield from _places(
                part.key.variants()[values.get(part.key.tag, part.key.default_kind)], values, where
            )
        elif part.tables:
            yield here, part
            tables = values.get(part.name) or [{}]
            yield from _places(part.table, tables[-1], (*here, len(tables) - 1))
        elif part.table:
            yield from _places(part.table, values.get(part.name, {}), here)
        else:
            yield here, part


@st.composite
def values(draw, part):
    """Strategy for a value of a key: inside, at and outside of its bounds, of other types, hostile."""
    way = draw(st.integers(0, 9))
    key, listed = part.key, typing.get_origin(part.type) is tuple
    bounds = [each for each in (key.at_least, key.above, key.at_most) if each is not None]
    if way < 5 and bounds:
        bound = draw(st.sampled_from(bounds))
        near = [
            bound,
            bound + 1,
            bound - 1,
            math.nextafter(bound, math.inf),
            math.nextafter(bound, -math.inf),
        ]
        value = draw(st.sampled_from(near))
        value = int(value) if part.type is int else value
    elif way < 7 and key.names():
        value = draw(st.sampled_from(sorted(key.names())))
    elif way < 7 and part.type is datetime.datetime:
        return _Raw(draw(st.sampled_from(MOMENTS)))
    elif way < 7 and part.type is bool:
        value = draw(st.booleans())
    elif way < 8:
        value = draw(st.sampled_from(TEXTS))
    else:
        value = draw(st.sampled_from((*NUMBERS, *OTHERS, *TEXTS)))
    return draw(st.lists(st.just(value), max_size=4)) if listed and way % 2 else value


class _Raw(str):
    """Text of a TOML value."""


@st.composite
def scenes(draw, kind=None):
    """Strategy for a scene file: a valid one with a camera of a kind, and one or two keys changed."""
    tables = plain(kind or draw(st.sampled_from(sorted(kinds()))))
    if draw(st.booleans()):
        method = draw(st.sampled_from(("flow", "preview")))
        tables["smoke"] = {"method": method, "cell_budget": 0.1, "spin_up": 60.0}
    for _ in range(draw(st.integers(1, 2))):
        try:
            known = list(_places(Settings, tables))
        except (KeyError, TypeError, AttributeError):  # the first change removed the place of another
            break
        where, part = draw(st.sampled_from(known))
        put = draw(values(part))
        with contextlib.suppress(KeyError, TypeError, IndexError, AttributeError):
            _put(tables, where, put)
    text = "\n".join(f"{name} = {written(value)}" for name, value in tables.items()) + "\n"
    if draw(st.integers(0, 19)) == 0:
        at = draw(st.integers(0, len(text)))
        text = (
            text[:at]
            + draw(st.sampled_from(("", '"', "]", "\0", "\x1b", '"\\u001b" = 1\n')))
            + text[at + 1 :]
        )
    return text


def _put(tables, where, value):
    for name, after in itertools.pairwise(where):
        if isinstance(name, str):
            tables.setdefault(name, [{}] if isinstance(after, int) else {})
        tables = tables[name]
    tables[where[-1]] = value


def written(value):
    """A value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name} = {written(each)}" for name, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, str) and not isinstance(value, _Raw):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return str(value).lower() if isinstance(value, bool) else str(value)


def outcome(path, build=None):
    """Check, plan and perhaps build a scene file: the last stage reached, and the error line, if any.

    Parameters
    ----------
    build
        Function that builds a shot.
    """
    stage = "check"
    try:
        choice = ShotSource(scene=str(path))
        choice.settings()
        stage = "plan"
        shot = choice.shot()
        plan.pictures(shot)
        assert all(np.isfinite(way.position).all() and np.isfinite(way.rotation).all() for way in shot.paths)
        if build:
            stage = "build"
            build(shot)
    except Exception as error:
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            cli._report(error)
        return stage, said.getvalue()
    return stage, ""


def whole(folder: Path) -> Path:
    """A folder with the run in it, deep enough that no ``..`` of a scene leaves the folder."""
    inner = folder / "a" / "b" / "c"
    inner.mkdir(parents=True)
    run(inner / "run")
    return inner
