"""Sources of smoke: what each says of itself, which a shot has, and how one more is added."""

import ast
import inspect
import sys
from pathlib import Path

import pytest
from firetwin.errors import Error
from firetwin.render import plan
from firetwin.render.picture import Picture
from firetwin.run import burning
from firetwin.run import opening as runs
from firetwin.shot.sections import SmokeSettings, Time
from firetwin.shot.sections.smoke import SMOKE_METHODS
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import bake, sources

ADDON = Path(inspect.getfile(sources)).parents[2]
KNOWN = sources.known()

SOOT = '''"""Smoke that a tiny model calls soot."""
from firetwin.smoke.sources import Source, VolumeLayer
import numpy as np
from firetwin_core import volume

class Soot(Source):
    name = "soot"
    {says}

    def voxels(self):
        return [50.0]

    def layers(self):
        return [VolumeLayer("smoke", 50.0, 50.0, 0.01)]

    def write(self, path, frame):
        return volume.write(path, {{"density": np.full((2, 2, 2), 0.01 * frame)}}, 50.0)

SOURCE = Soot
'''


@pytest.fixture
def soot(tmp_path, monkeypatch):
    """Add a source by a separate file with this content."""

    def add(says):
        folder = tmp_path / "more"
        folder.mkdir()
        (folder / "soot.py").write_text(SOOT.format(says=says))
        (folder / "_helper.py").write_text("raise ImportError")
        monkeypatch.setattr(sources, "__path__", [*sources.__path__, str(folder)])
        sources.known.cache_clear()

    yield add
    sources.known.cache_clear()
    sys.modules.pop(f"{sources.__name__}.soot", None)


@pytest.fixture
def shot(tmp_path, make_run):
    """Make a still of the small run, with smoke as these keys of [smoke] say."""
    run = runs.open(make_run())

    def make(**smoke):
        settings = Settings(cache=tmp_path / "cache", time=Time(frames=1), smoke=SmokeSettings(**smoke))
        return Shot(settings, run)

    return make


@pytest.mark.parametrize("name", KNOWN)
def test_a_source_says_what_it_is(name):
    each = KNOWN[name]
    module = sys.modules[f"{sources.__name__}.{name}"]
    assert each.name == name
    assert module.SOURCE is each
    assert module.__doc__
    assert each.__doc__
    assert each.preview_of in ("", *SMOKE_METHODS)
    assert f"smoke/sources/{name}.py" in each.code_files()
    assert all((ADDON / place).exists() for place in each.code_files())


def test_what_a_scene_file_can_choose_is_what_the_folder_holds():
    assert list(SMOKE_METHODS) == [name for name, source in KNOWN.items() if not source.fields]
    for text in SMOKE_METHODS.values():
        assert text.strip(" .") == text


def test_the_fields_of_a_run_go_before_the_method():
    for method in SMOKE_METHODS:
        assert sources.choose(method, {"heat_flux"}).name == method
        assert sources.choose(method, {"heat_flux", "smoke_3d"}).name == "model"


def test_no_module_but_the_sources_compares_the_method():
    """Neither `method == "flow"` nor `"preview" in ...`: what hangs on it, the source says."""
    names = set(KNOWN)
    for path in ADDON.rglob("*.py"):
        if path.parent.name == "sources":
            continue
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)) if ".method" in text else ():
            if isinstance(node, ast.Compare):
                sides = [node.left, *node.comparators]
                asks = any(isinstance(side, ast.Attribute) and side.attr == "method" for side in sides)
                named = {side.value for side in ast.walk(node) if isinstance(side, ast.Constant)} & names
                assert not (asks and named), f"{path}:{node.lineno} compares the method"


def test_the_fire_is_known_for_as_long_as_smoke_is_shown(shot):
    for method in SMOKE_METHODS:
        assert shot(method=method, spin_up=70_000.0).fire.before == 70_000.0 + burning.BURN_TIME


def test_a_source_that_a_run_brings_is_added_by_one_file(shot, soot):
    soot('fields = ("temperature",)')
    sooty = shot(method="flow")
    assert sources.select(sooty).name == "soot"
    place = bake.bake(sooty)
    assert [path.name for path in place.glob("*.vdb")] == ["smoke_000001.vdb"]
    assert sources.select(sooty).cost() is None
    assert not sources.is_integrated(sooty)
    plan.check_marched(sooty, [Picture("drone", 1, "rgb")])
    with pytest.raises(Error, match="leave comp out of the passes"):
        plan.check_marched(sooty, [Picture("drone", 1, "comp")])
