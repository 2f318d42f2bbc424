"""Scene files with anything in them: each is a scene that can be planned, or one polite line says why not."""

import contextlib
import os

import polite
import pytest
import scene_fuzz
from firetwin.shot.cameras.rigs import kinds
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return scene_fuzz.whole(tmp_path_factory.mktemp("hostile"))


@pytest.mark.parametrize("kind", sorted(kinds()))
@settings(max_examples=examples(25), suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_scene_file_is_planned_or_refused_politely(folder, kind, data):
    path = folder / "scene.toml"
    with contextlib.chdir(folder):
        path.write_text(data.draw(scene_fuzz.scenes(kind)), encoding="utf-8")
        _, line = scene_fuzz.outcome(path)
    assert not polite.rude(line), line


@pytest.mark.parametrize("kind", sorted(kinds()))
def test_what_is_changed_is_a_scene_that_can_be_planned(folder, kind):
    path = folder / "scene.toml"
    values = scene_fuzz.plain(kind)
    path.write_text("\n".join(f"{name} = {scene_fuzz.written(each)}" for name, each in values.items()))
    with contextlib.chdir(folder):
        assert scene_fuzz.outcome(path) == ("plan", "")


@pytest.mark.parametrize(
    ("section", "name"),
    [
        ("places", "file"),
        *(("ground", name) for name in ("photo", "elevation", "land_use")),
        ("fire", "observed"),
    ],
)
@pytest.mark.parametrize("end", [".geojson", ".tif"])
def test_a_pipe_in_place_of_a_file_is_not_waited_for(folder, section, name, end):
    path, pipe = folder / "scene.toml", folder / f"pipe{end}"
    if not pipe.exists():
        os.mkfifo(pipe)
    path.write_text(
        f'run = "run"\n[{section}]\n{name} = "{pipe.name}"\n' + "enabled = true\n" * (name == "file")
    )
    with contextlib.chdir(folder):
        stage, line = scene_fuzz.outcome(path)
    assert stage == "plan"
    assert pipe.name in line
    assert not polite.rude(line)
