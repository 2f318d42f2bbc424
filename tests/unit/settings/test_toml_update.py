"""Saving over a scene file: changed values are written, and the rest stays."""

import dataclasses
import difflib
import re
import tomllib
from pathlib import Path

import pytest
from any_settings import SCENES, any_table
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.settings import Settings, scene_file, toml_update
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

HERE = SCENES / "scene.toml"
EXAMPLE = Path(__file__).parents[3] / "examples" / "king_fire.toml"
SCENE = """\
# A briefing for the county.
run = "king"   # as of Tuesday
seed = 3

[time]
fps = 12       # slow on purpose
# Nothing below is sure.

# Smoke was heavy.
[smoke]
enabled = true

# Follows the head.

# The drone of the second day
[[cameras]]
name = "drone" # ours
keys = [{at = 0.0, latitude = 38.5}, # take-off
        {at = 1.0, latitude = 38.6}]

# The tower on the ridge
[[cameras]]
name = "tower"
kind = "lookout"
# the end
"""


def read(text):
    return scene_file.parse(text, HERE)


def lines(before, after):
    """Lines that are removed and added."""
    found = difflib.unified_diff(before.splitlines(), after.splitlines(), n=0)
    return [line for line in list(found)[2:] if line[0] in "-+"]


def comments(text):
    return sorted(re.findall(r"(?m)(?:^|\s)(# .*)$", text))


def test_nothing_changed_changes_nothing():
    assert toml_update.updated(SCENE, read(SCENE)) == SCENE
    example = EXAMPLE.read_text(encoding="utf-8")
    assert toml_update.updated(example, read(example)) == example


def test_a_changed_key_changes_one_line():
    whole = read(SCENE)
    faster = dataclasses.replace(whole, time=dataclasses.replace(whole.time, fps=30))
    changed = toml_update.updated(SCENE, faster)
    assert lines(SCENE, changed) == ["-fps = 12       # slow on purpose", "+fps = 30       # slow on purpose"]


def test_a_key_and_a_section_that_were_left_out_are_put_in_their_places():
    whole = read(SCENE)
    whole = dataclasses.replace(
        whole,
        time=dataclasses.replace(whole.time, frames=99),
        terrain=dataclasses.replace(whole.terrain, apron=7.0),
    )
    assert lines(SCENE, toml_update.updated(SCENE, whole)) == [
        "+frames = 99",
        "+",
        "+[terrain]",
        "+apron = 7.0",
    ]


def test_cameras_take_their_comments_along():
    whole = read(SCENE)
    drone, tower = whole.cameras
    turned = toml_update.updated(SCENE, dataclasses.replace(whole, cameras=(tower, drone)))
    assert comments(turned) == comments(SCENE)
    assert re.search(r"# The tower on the ridge\n\[\[cameras\]\]\nname = \"tower\"", turned)
    assert re.search(r"# The drone of the second day\n\[\[cameras\]\]\nname = \"drone\"", turned)
    alone = toml_update.updated(SCENE, dataclasses.replace(whole, cameras=(tower,)))
    assert "of the second day" not in alone
    assert re.search(r"# The tower on the ridge\n\[\[cameras\]\]\nname = \"tower\"", alone)
    third = dataclasses.replace(tower, name="third")
    more = toml_update.updated(SCENE, dataclasses.replace(whole, cameras=(drone, third, tower)))
    assert comments(SCENE) == [each for each in comments(more) if each in comments(SCENE)]
    assert [each.name for each in read(more).cameras] == ["drone", "third", "tower"]
    renamed = toml_update.updated(SCENE, dataclasses.replace(whole, cameras=(drone, third)))
    assert lines(SCENE, renamed) == ['-name = "tower"', '+name = "third"']


def test_a_key_of_a_path_changes_in_its_line():
    whole = read(SCENE)
    drone, tower = whole.cameras
    first, last = drone.rig.keys
    keys = (first, dataclasses.replace(last, latitude=38.75))
    whole = dataclasses.replace(
        whole, cameras=(dataclasses.replace(drone, rig=dataclasses.replace(drone.rig, keys=keys)), tower)
    )
    assert lines(SCENE, toml_update.updated(SCENE, whole)) == [
        "-        {at = 1.0, latitude = 38.6}]",
        "+        {at = 1.0, latitude = 38.75}]",
    ]
    keys = (*keys[:1], CameraKey(at=0.5), *keys[1:])
    more = dataclasses.replace(drone, rig=dataclasses.replace(drone.rig, keys=keys))
    assert (
        len(read(toml_update.updated(SCENE, dataclasses.replace(whole, cameras=(more,)))).cameras[0].rig.keys)
        == 3
    )


@pytest.mark.parametrize("there", ["", "no TOML [", "unknown = 1", "\ufeff", "[[cameras]]\nname = 3"])
def test_what_is_no_scene_file_is_replaced(there):
    assert tomllib.loads(toml_update.updated(there, read(SCENE))) == tomllib.loads(
        scene_file.text(read(SCENE))
    ) or there in ("", "\ufeff")


@pytest.mark.parametrize(
    "there", ["cameras = [{name = 'drone'}]\n", "time.fps = 12 # slow\n", "[ground]\n# flat\n"]
)
def test_other_ways_to_write_tables_stay_or_are_replaced(there):
    whole = dataclasses.replace(read(SCENE), terrain=dataclasses.replace(Settings().terrain, apron=7.0))
    assert read(toml_update.updated(there, whole)) == whole


def test_line_ends_and_fresh_files(tmp_path):
    path = tmp_path / "scene.toml"
    run, cache = (Path(path.anchor, name) for name in ("king", "cache"))
    whole = dataclasses.replace(read(""), path=path, run=run, cache=cache)
    toml_update.save(whole)
    assert path.read_bytes() == scene_file.text(whole).encode()
    path.write_bytes(b'run = "/king" # ours\r\ncache = "/cache"\r\n')
    toml_update.save(dataclasses.replace(whole, seed=5))
    assert path.read_bytes() == b'run = "/king" # ours\r\ncache = "/cache"\r\nseed = 5\r\n'


ANY = any_table(Settings, path=st.just(HERE))


@settings(max_examples=examples(10), deadline=None)
@given(ANY, ANY)
def test_any_scene_file_saved_over_any_other_reads_back(before, after):
    there = "\n".join(f"{line}\n# {i}" for i, line in enumerate(scene_file.text(before).split("\n")))
    found = toml_update.updated(there, after)
    assert tomllib.loads(scene_file.text(read(found))) == tomllib.loads(scene_file.text(after))
    known, kept = (re.findall(r"(?m)^# (\d+)$", each) for each in (there, found))
    assert kept[0] == "0"  # its layout stayed
    assert kept == known or before.cameras or before.runs
    assert toml_update.updated(found, after) == found


@pytest.mark.parametrize("enabled", [False, True])
def test_former_names_give_way_to_present_ones_in_their_places(enabled):
    text = "# Ours\n[ground]\napron = 7000.0 # far\n[places]\nenabled = false # for comparison\n"
    found = read(text)
    wanted = dataclasses.replace(found, labels=dataclasses.replace(found.labels, enabled=enabled))
    expected = text.replace("[ground]", "[terrain]").replace("[places]", "[labels]")
    expected = expected.replace("= false", f"= {str(enabled).lower()}")
    assert toml_update.updated(text, wanted) == expected
    assert read(expected).notes == ()


def test_several_former_names_of_a_line_and_former_values_give_way_too():
    text = '[smoke]\nmethod = "puffs" # quick\n'
    assert toml_update.updated(text, read(text)) == '[smoke]\nmethod = "preview" # quick\n'
    text = 'tiles = { error = 3.0, trees = "ours where it burns", sources = ["a"] } # ours\n'
    found = read(text)
    expected = (
        'tiles = { max_screen_space_error = 3.0, vegetation = "scene_near_burn", sources = ["a"] } # ours\n'
    )
    assert toml_update.updated(text, found) == expected
    assert read(expected).notes == ()
