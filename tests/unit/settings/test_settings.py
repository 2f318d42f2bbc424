"""The settings' schema: single definitions, and everything derived from them."""

import dataclasses
import re
import tomllib
from datetime import UTC, date, datetime, timedelta, timezone
from pathlib import Path

import jsonschema
import pytest
from firetwin.errors import InputError
from firetwin.shot import passes, schema
from firetwin.shot.cameras.rigs import kinds
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.schema.json_schema import json_schema
from firetwin.shot.sections import FireSettings, Time
from firetwin.shot.settings import Camera, Render, Settings, scene_file

ROOT = Path(__file__).parents[3]
DRONE, SATELLITE = kinds()["drone"], kinds()["satellite"]
ASPECTS = {
    *("time", "terrain", "forest", "fire", "smoke", "light", "camera"),
    *("picture", "colour", "grain", "thermal", "film", "sidecar"),
}

SETTINGS = Settings(
    time=Time(start=datetime(2014, 9, 17, 23, tzinfo=UTC)),
    cameras=(
        Camera("one", DRONE(keys=(CameraKey(latitude=38.9), CameraKey(1.0, 39.0)))),
        Camera("two", SATELLITE()),
    ),
)


def with_(settings, path, value):
    """The settings with another value at a path of names and indices."""
    if not path:
        return value
    name, *rest = path
    if isinstance(name, int):
        return tuple(with_(v, rest, value) if i == name else v for i, v in enumerate(settings))
    return dataclasses.replace(settings, **{name: with_(getattr(settings, name), rest, value)})


def test_every_key_is_explained_in_one_line():
    keys = list(schema.walk(Settings))
    assert {part.name for section, part in keys if section == ("cameras",)} > {"focal_length", "swath"}
    for section, part in keys:
        help = part.key.help
        assert re.fullmatch(r"\S.*[^.\s]", help), (section, part.name)
        assert not part.key.names() or all(isinstance(name, str) for name in part.key.names())
        assert set(part.key.affects or ()) <= ASPECTS


def test_every_default_is_right():
    assert schema.validate(Settings()) is None
    assert schema.validate(SETTINGS) is None
    assert Settings().time == Time()
    assert Camera().kind == "drone"


# Path, value, path of the error, and words in it.
WRONG = [
    (("fire", "budget"), -1, ["fire.budget", "from 0 to 10,000,000, not -1"]),
    (("smoke", "method"), "flows", ['"flow" or "preview", not "flows"', 'did you mean "flow"?']),
    (("render", "resolution"), (640, 20000), ["from 16 to 16,384, not 20000"]),
    (("render", "passes"), (), ["is empty"]),
    (("seed",), -1, ["seed must be from 0 to 2,147,483,647, not -1"]),
    (("cameras", 1, "rig", "swath"), 0.0, ["cameras.swath", "from 1 to 10,000,000, not 0"]),
    (("render", "thermal_high"), 0.0, ["render.thermal_high", "above 0 and at most 10,000, not 0"]),
    (
        ("cameras", 0, "rig", "keys", 1, "latitude"),
        90.5,
        ["cameras.keys.latitude", "from -90 to 90, not 90.5"],
    ),
    (("cameras", 0, "rig", "keys", 1, "at"), 0.0, ['camera "one"', "must rise"]),
    (("cameras", 0, "rig", "keys"), (), ['camera "one"', "[[cameras.keys]]"]),
    (("cameras", 1, "name"), "one", ["names must differ"]),
    (("cameras", 1, "frames"), "40-49", ['"40-49" is outside of 1-48']),
]


@pytest.mark.parametrize(("path", "value", "words"), WRONG)
def test_settings_made_by_hand_are_checked_like_a_file(path, value, words):
    where, reason = schema.validate(with_(SETTINGS, path, value))
    assert where == tuple(name for name in path if name != "rig")  # keys of a rig are in the camera's table
    assert all(word in reason for word in words), reason


def test_what_a_product_depends_on_is_chosen_by_aspect():
    time = {"start": "2014-09-17T23:00:00+00:00", "end": None, "frames": 48}
    assert schema.select(SETTINGS, {"time"}) == {"time": time}
    assert schema.select(SETTINGS, {"film"}) == {"time": {"fps": 24, "zone": ""}}
    assert schema.select(SETTINGS, {"picture"}) == {"render": {"engine": "cycles", "resolution": [640, 360]}}
    grain = {"samples": 6, "denoise": True, "motion_blur": 0.0, "seed": 0}
    assert schema.select(SETTINGS, {"grain"}) == {"time": {"shutter": None}, "render": grain}
    chosen = schema.select(SETTINGS, {"thermal"})
    assert chosen["render"] == {"thermal_low": None, "thermal_high": 800.0}
    assert chosen["thermal"]["band"] == "lwir"
    chosen = schema.select(SETTINGS, {"terrain"})["forest"]  # the colours of what grows on it, or is left out
    assert set(chosen) == {"biome", "budget", "greenness", "shrub_cover", "tree_cover", "widening"}
    for aspect in ("terrain", "forest", "fire", "smoke"):
        chosen = schema.select(SETTINGS, {aspect})
        more = {"terrain": {"forest", "tiles"}, "forest": {"tiles"}}.get(aspect, set())
        chunk = {} if aspect == "smoke" else {"render": {"chunk": 480}}
        assert set(chosen) == {"seed", aspect, *chunk} | more
        assert {name: chosen[name] for name in chunk} == chunk
    assert set(schema.select(SETTINGS, {"light"})) == {"light"}
    assert schema.select(SETTINGS, set()) == {}


def test_moving_one_camera_leaves_what_another_shows():
    one, two = (schema.select(SETTINGS, {"camera"}, name)["cameras"] for name in ("one", "two"))
    assert two == [
        {"kind": "satellite", "swath": 56000.0, "geostationary": None, "frames": "", "resolution": None}
    ]
    assert [table["kind"] for table in one] == ["drone"]
    assert [key["latitude"] for key in one[0]["keys"]] == [38.9, 39.0]
    assert schema.select(SETTINGS, {"camera"})["cameras"] == one + two
    moved = with_(SETTINGS, ("cameras", 0, "rig", "keys", 0, "latitude"), 38.8)
    assert schema.select(moved, ASPECTS, "two") == schema.select(SETTINGS, ASPECTS, "two")
    assert schema.select(moved, ASPECTS, "one") != schema.select(SETTINGS, ASPECTS, "one")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("run",), Path("elsewhere")),
        (("cache",), Path("elsewhere")),
        (("render", "device"), "cpu"),
        (("render", "video"), False),
        (("cameras", 0, "name"), "other"),
    ],
)
def test_what_shows_nothing_is_never_chosen(path, value):
    assert schema.select(with_(SETTINGS, path, value), ASPECTS) == schema.select(SETTINGS, ASPECTS)


def test_equal_settings_are_chosen_as_equal_json():
    west = timezone(timedelta(hours=-7))
    same = with_(SETTINGS, ("time", "start"), datetime(2014, 9, 17, 16, tzinfo=west))
    same = with_(same, ("cameras", 0, "rig", "keys", 0, "target_latitude"), -0.0)
    same = with_(same, ("light", "haze"), 1)
    assert same == SETTINGS
    assert repr(schema.select(same, ASPECTS)) == repr(schema.select(SETTINGS, ASPECTS))


def test_the_pass_thermal_depends_on_smoke_and_its_own_settings():
    aspects = passes.known()["thermal"].aspects
    assert "thermal" in aspects
    assert "smoke" in aspects
    changed = dataclasses.replace(
        SETTINGS, render=Render(thermal_high=900.0), fire=FireSettings(torches=False)
    )
    depth = passes.known()["depth"].aspects
    assert schema.select(changed, depth) == schema.select(SETTINGS, depth)


# Files for editors.

VALIDATOR = jsonschema.Draft202012Validator(json_schema(Settings))

EXAMPLES = [
    ROOT / "examples" / "king_fire.toml",
    *sorted((ROOT / "examples" / "views").glob("*.toml")),
]


def as_json(value):
    if isinstance(value, dict):
        return {name: as_json(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [as_json(inner) for inner in value]
    return value.isoformat() if isinstance(value, date) else value


def test_the_json_schema_is_one():
    json_schema_ = json_schema(Settings)
    jsonschema.Draft202012Validator.check_schema(json_schema_)
    assert json_schema_["properties"]["time"]["properties"]["start"]["format"] == "date-time"
    error = json_schema_["properties"]["terrain"]["properties"]["error"]
    assert error == {
        "description": "mesh tolerance: largest vertical error seen by a camera, pixels; larger is coarser",
        "type": "number",
        "minimum": 0.001,
        "maximum": 1000,
        "default": 0.05,
    }
    high = json_schema_["properties"]["render"]["properties"]["thermal_high"]
    assert (high["exclusiveMinimum"], high["maximum"]) == (0, 10_000)
    assert json_schema_["properties"]["render"]["properties"]["engine"]["enum"] == ["cycles", "eevee"]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_json_schema_accepts_the_examples(path):
    scene_file.read(path)
    VALIDATOR.validate(as_json(tomllib.loads(path.read_text(encoding="utf-8"))))


REFUSED = [
    "sed = 1",
    "seed = -1",
    "run = 3",
    "[terrains]",
    "[time]\nframes = 0",
    "[time]\nframes = true",
    "[time]\nframes = 1.5",
    '[time]\nstart = "yesterday"\nfps = "12"',
    "[terrain]\nerror = 0",
    "[terrain]\napron = -1",
    "[forest]\ntrees = 1",
    '[fire]\nemitters = "edge"',
    "[light]\nexposure = 21",
    "light = 3",
    "[render]\nresolution = [640]",
    "[render]\nresolution = [640, 20000]",
    '[render]\ndevice = "tpu"',
    '[render]\npasses = ["rgb", "rgb"]',
    '[render]\npasses = ["x"]',
    "[cameras]\nname = 'x'",
    '[[cameras]]\nkind = "plane"',
    '[[cameras]]\nkind = "satellite"\nfocal_length = 28.0',
    "[[cameras]]\nswath = 1.0\nkeys = [{}]",
    "[[cameras]]\nfocal_length = 0.5\nkeys = [{}]",
    "[[cameras]]\nkeys = [{latitude = 91}]",
    "[[cameras]]\nkeys = [{target = 'x'}]",
    "[[cameras]]\nkeys = [{colour = 'red'}]",
]


@pytest.mark.parametrize("text", REFUSED)
def test_the_json_schema_refuses_what_the_reader_refuses(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(InputError):
        scene_file.read(path)
    assert not VALIDATOR.is_valid(as_json(tomllib.loads(text)))
