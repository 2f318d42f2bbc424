"""Kinds of camera: each is one file."""

import dataclasses
import sys
from pathlib import Path

import jsonschema
import pytest
from firetwin.errors import InputError
from firetwin.shot import schema
from firetwin.shot.cameras import rigs
from firetwin.shot.schema.json_schema import json_schema
from firetwin.shot.settings import Camera, Settings, scene_file

TOWER = '''\
"""A tower: a camera on the ground."""
from dataclasses import dataclass

from firetwin.shot.cameras.rigs import Rig
from firetwin.shot.schema import key


@dataclass(frozen=True)
class Tower(Rig):
    """On the ground, turning round."""

    mast: float = key(20.0, "length of the mast", unit="m", above=0)
    turns: int = key(1, "how often it turns", at_least=0)

    def validate(self):
        return (("turns",), "turns faster than a short mast bears") if self.turns > self.mast else None


RIG = Tower
'''


@pytest.fixture
def tower(tmp_path, monkeypatch):
    folder = tmp_path / "rigs"
    folder.mkdir()
    (folder / "tower.py").write_text(TOWER)
    (folder / "_helper.py").write_text("raise ImportError")
    monkeypatch.setattr(rigs, "__path__", [*rigs.__path__, str(folder)])
    rigs.kinds.cache_clear()
    yield rigs.kinds()["tower"]
    rigs.kinds.cache_clear()
    sys.modules.pop(f"{rigs.__name__}.tower")


@pytest.mark.parametrize("name", rigs.kinds())
def test_a_kind_says_what_it_is(name):
    kind = rigs.kinds()[name]
    assert sys.modules[f"{rigs.__name__}.{name}"].RIG is kind
    assert dataclasses.is_dataclass(kind)
    assert issubclass(kind, rigs.Rig)
    assert Camera("x", kind()).kind == name
    assert schema.summary(kind)[0].islower()
    own = {part.name for part in schema.fields(kind)}
    assert not own & ({"kind"} | {part.name for part in schema.fields(Camera)}), "they lie in one table"


def test_a_kind_is_added_by_one_file(tower, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('[[cameras]]\nkind = "tower"\nname = "lookout"\nmast = 30\n')
    camera = scene_file.read(path).cameras[0]
    assert camera == Camera("lookout", tower(mast=30.0))
    assert camera.kind == "tower"
    settings = dataclasses.replace(scene_file.read(path), path=Path("scene.toml"))
    assert "mast = 30.0                 # length of the mast, m (default 20.0)" in scene_file.text(settings)
    assert "kind of camera: on the ground, turning round" in scene_file.text(settings)
    tables = [{"kind": "tower", "mast": 30.0, "turns": 1, "frames": "", "resolution": None}]
    assert schema.select(settings, {"camera"}) == {"cameras": tables}
    validator = jsonschema.Draft202012Validator(json_schema(Settings))
    assert validator.is_valid({"cameras": [{"kind": "tower", "mast": 30}]})
    assert not validator.is_valid({"cameras": [{"kind": "tower", "mast": 0}]})


@pytest.mark.parametrize(
    ("lines", "line", "words"),
    [
        ("mast = 0", 3, "cameras.mast must be above 0, not 0"),
        ("turns = 99", 3, 'camera "drone" turns faster than a short mast bears'),
        ("swath = 5.0", 3, 'swath belongs to kind "minimap" or "satellite"'),
        ("keys = []", 3, 'keys belongs to kind "drone", "lookout", "poses", "satellite" or "vr"'),
        ("masts = 5.0", 3, 'did you mean "mast"?'),
    ],
)
def test_mistakes_in_an_added_kind_have_their_place(tower, tmp_path, lines, line, words):
    path = tmp_path / "scene.toml"
    path.write_text(f'[[cameras]]\nkind = "tower"\n{lines}\n')
    with pytest.raises(InputError) as caught:
        scene_file.read(path)
    assert (caught.value.line, caught.value.column) == (line, 1)
    assert words in caught.value.reason
