import dataclasses
import tomllib
import typing
from datetime import UTC, datetime
from pathlib import Path

import pytest
from firetwin import frame_list, project, toml_places
from firetwin.errors import InputError

EXAMPLE = Path(__file__).parents[2] / "examples" / "king_fire.toml"

SCENE = """\
run = "elsewhere/run"  # a comment = "not a key"

[time]
start = 2014-09-17T14:30:00-07:00
end = 2014-09-18T00:00:00Z
frames = 10

[render]
resolution = [320, 180]
passes = ["rgb",
          "depth"]

[[cameras]]
name = "one"
keys = [{at = 0, latitude = 38.9, longitude = -120.5},
        {at = 1.0, latitude = 39.0, longitude = -120.4, target = "head"}]

[[cameras]]
name = "two"
kind = "satellite"
frames = "1,4-6"
"""


@pytest.fixture
def load(tmp_path):
    def write_and_load(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return project.load(path)

    return write_and_load


def test_values_are_read_and_the_rest_is_default(load, tmp_path):
    loaded = load(SCENE)
    assert loaded.run == tmp_path / "elsewhere" / "run"
    assert loaded.cache == tmp_path / "cache"
    assert loaded.time.start == datetime(2014, 9, 17, 21, 30, tzinfo=UTC)
    assert loaded.time.frames == 10
    assert loaded.render.resolution == (320, 180)
    assert loaded.render.passes == ("rgb", "depth")
    assert [camera.name for camera in loaded.cameras] == ["one", "two"]
    assert loaded.cameras[0].keys[1].target == "head"
    assert loaded.terrain == project.Terrain()


def test_an_empty_file_is_all_defaults(load, tmp_path):
    assert dataclasses.replace(load(""), path=Path("scene.toml")) == project.Project(
        run=tmp_path / "sample", cache=tmp_path / "cache"
    )


# What is replaced by what, the line and column of the complaint, and words it must hold.
MISTAKES = [
    ("kind =", "kidn =", 20, 1, ['unknown key "kidn"', 'did you mean "kind"?']),
    ("[render]", "[rendr]", 8, 2, ['unknown key "rendr"', '"render"']),
    ("frames = 10", "frames = 0", 6, 1, ["time.frames", "from 1 to 100,000"]),
    ("frames = 10", 'frames = "10"', 6, 1, ["a whole number", '"10"']),
    ("frames = 10", "frames = 1.5", 6, 1, ["a whole number", "1.5"]),
    ("frames = 10", "frames = true", 6, 1, ["a whole number", "true"]),
    ("frames = 10", "fps = 0\nframes = 10", 6, 1, ["time.fps"]),
    ("frames = 10", 'zone = "America/Los_Angles"', 6, 1, ["time zone", "America/Los_Angeles"]),
    ("T14:30:00-07:00", "T14:30:00", 4, 1, ["no zone", "Z"]),
    ("2014-09-18T", "2014-09-16T", 5, 1, ["later than time.start"]),
    ("[320, 180]", "[320, 181]", 9, 1, ["even"]),
    ("[320, 180]", "[320]", 9, 1, ["2 values"]),
    ('"depth"', '"deph"', 10, 1, ['"deph"', 'did you mean "depth"?']),
    ('"depth"', '"rgb"', 10, 1, ["twice"]),
    ('"head"', '"haed"', 16, 57, ["cameras.keys.target", 'did you mean "head"?']),
    ("latitude = 39.0", "latitude = 390", 16, 20, ["from -90 to 90", "390"]),
    ("latitude = 39.0", "latitude = nan", 16, 20, ["must be a number"]),
    ("at = 1.0", "at = 0", 16, 10, ["must rise"]),
    ('"two"', '"one"', 19, 1, ['"one"', "differ"]),
    ('"two"', '"../two"', 19, 1, ["letters, digits"]),
    ('"1,4-6"', '"1,4-60"', 21, 1, ['"4-60"', "1-10"]),
    ('"1,4-6"', '"4 to 6"', 21, 1, ['"4 to 6"', "1-48:4"]),
    ('"satellite"', '"drone"', 18, 3, ['"two"', "[[cameras.keys]]"]),
    ('run = "elsewhere/run"', "run = 3", 1, 1, ["text in quotes", "3"]),
    ('run = "elsewhere/run"', "run", 1, 6, ["not valid TOML"]),
    ('"two"', '"two', 19, 12, ["not valid TOML"]),
    ("[320, 180]", "[320, 180]\nthermal_high = 200", 10, 1, ["thermal_high", "thermal_low"]),
    ("[320, 180]", '[320, 180]\nengine = "evee"', 10, 1, ['"eevee"']),
]


@pytest.mark.parametrize(("old", "new", "line", "column", "words"), MISTAKES)
def test_mistakes_are_named_with_their_place(load, tmp_path, old, new, line, column, words):
    assert SCENE.count(old) == 1
    with pytest.raises(InputError) as caught:
        load(SCENE.replace(old, new))
    error = caught.value
    assert (error.path, error.line, error.column) == (str(tmp_path / "scene.toml"), line, column)
    assert str(error) == f"{error.path}:{line}:{column}: {error.reason}"
    assert all(word in error.reason for word in words)
    assert "\n" not in error.reason


def test_a_missing_file_and_one_that_is_not_text(tmp_path):
    with pytest.raises(InputError, match="no such scene file"):
        project.load(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="cannot be read as text"):
        project.load(tmp_path / "bytes.toml")


def test_places_of_keys_in_every_kind_of_toml():
    text = (
        'a.b = 1\n"q k" = """x\n[no]\ny = 2"""\n[t] # [c]\n  d = [1, {e = \'=\'}, """]"""]\r\n'
        "[[l]]\nx = 1979-05-27 07:32:00Z\n[[l.m]]\ny=1\n[[l]]\n[l.n]\nz=0\n"
    )
    tomllib.loads(text)
    places = toml_places.places(text.replace("\r\n", "\n"))
    expected = {
        ("a", "b"): (1, 3),
        ("q k",): (2, 1),
        ("t", "d"): (6, 3),
        ("t", "d", 1, "e"): (6, 12),
        ("t", "d", 2): (6, 22),
        ("l", 0, "x"): (8, 1),
        ("l", 0, "m", 0, "y"): (10, 1),
        ("l", 1, "n", "z"): (13, 1),
    }
    assert {path: places[path] for path in expected} == expected


def test_lists_of_frames():
    assert frame_list.parse("", 3) == [1, 2, 3]
    assert frame_list.parse(" 3, 5-6,1-9:4 ", 9) == [1, 3, 5, 6, 9]
    assert frame_list.write([1, 2, 3, 7, 9, 10]) == "1-3,7,9-10"
    for text in ("0", "4-2", "1-4:0", "x", "1,", "5"):
        with pytest.raises(ValueError, match=r"frames"):
            frame_list.parse(text, 4)


def _keys(kind):
    """Every key of a dataclass and of the dataclasses in it."""
    hints = typing.get_type_hints(kind)
    for field in dataclasses.fields(kind):
        parts = [hints[field.name], *typing.get_args(hints[field.name])]
        inner = [part for part in parts if dataclasses.is_dataclass(part)]
        yield field.name
        for part in inner:
            yield from (f"{field.name}.{name}" for name in _keys(part))


def _written(values):
    for name, value in values.items():
        yield name
        for table in value if isinstance(value, list) else [value]:
            if isinstance(table, dict):
                yield from (f"{name}.{inner}" for inner in _written(table))


def test_the_example_holds_every_key_and_explains_it():
    text = EXAMPLE.read_text(encoding="utf-8")
    project.load(EXAMPLE)
    assert set(_written(tomllib.loads(text))) == set(_keys(project.Project)) - {"path"}
    seen = set()
    for line in text.splitlines():
        key = line.partition("=")[0].strip()
        if "=" in line and not line.startswith("#"):
            assert "#" in line or key in seen or key in SELF_EXPLAINING, f"no comment: {line}"
            seen.add(key)


SELF_EXPLAINING = {"trees", "grass", "flames", "embers", "enabled", "passes"} | {
    "target_longitude",
}
