"""Terms of services: one error that names the policy, before any request or render."""

import subprocess

import pytest
from firetwin.errors import InputError
from firetwin.jobs import build, render, render_blend
from firetwin.jobs.tiles import make, selection
from firetwin.jobs.tiles.access import TileAccess
from firetwin.shot import passes
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource
from firetwin.shot.tiles import tile_terms
from firetwin.tiles import policies
from firetwin.tiles.policies import Policy, google, ion

GOOGLE = "https://tile.googleapis.com/v1/3dtiles/root.json"
TEXT = """run = "sample"
tiles = {{ sources = ["set", "{place}"], vegetation = "tileset" }}
{more}
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.98
longitude = -120.56
height = 600.0
target = "head"
"""


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """Write a scene file with a source; nothing of it may start a process."""

    def start(*_, **__):
        pytest.fail("a process was started")

    monkeypatch.setattr(subprocess.Popen, "__init__", start)

    def make(place=GOOGLE, more=""):
        path = tmp_path / "scene.toml"
        path.write_text(TEXT.format(place=place, more=more))
        return path

    return make


@pytest.mark.parametrize(
    ("place", "policy"),
    [
        (GOOGLE, google.POLICY),
        ("ion:2275207", google.POLICY),
        ("ion:96188", ion.POLICY),
        ("https://assets.ion.cesium.com/x/tileset.json", ion.POLICY),
        ("https://example.org/tileset.json", policies.OPEN),
        ("https://[broken/tileset.json", policies.OPEN),
        ("city.3tz", policies.OPEN),
        ("C:/city", policies.OPEN),
    ],
)
def test_a_policy_is_known_by_a_sources_name_alone(place, policy):
    assert policies.for_source(place) is policy


def test_every_use_is_an_attribute_of_policies():
    for use in tile_terms._REFUSED:
        assert tile_terms.allows(policies.OPEN, use) is True
        assert tile_terms.allows(google.POLICY, use) is False
    fields = {name.removeprefix("may_") for name in Policy.__dataclass_fields__ if name.startswith("may_")}
    assert fields - {"store", "prefetch"} == set(tile_terms._REFUSED) - {"other_geocoder"}


def test_the_error_is_at_the_source_in_the_scene_file(scene):
    settings = scene_file.read(scene())
    with pytest.raises(InputError) as caught:
        tile_terms.check(settings, [("flatten", "tiles.flatten")])
    error = caught.value
    assert (error.line, error.column) == (2, 29)
    assert error.reason == (
        f"{GOOGLE}: Google Photorealistic 3D Tiles does not allow that the surface of tiles is changed; "
        "leave out tiles.flatten, or this source"
    )
    tile_terms.check(scene_file.read(scene("https://example.org/t.json")), [("flatten", "x")])


@pytest.mark.parametrize("name", passes.known())
def test_passes_that_measure_tiles_are_refused_and_pictures_are_not(name):
    """Passes made from depth are rejected like depth."""
    allowed = {"rgb", "comp", "thermal", "split", "overlay"}
    assert bool(tile_terms.of_passes([name])) == (name not in allowed)
    if name == "fused":
        assert tile_terms.of_passes([name]) == [("analyse", 'the pass "fused", which is made from depth')]


def _refused(choice, use):
    with pytest.raises(InputError, match=f"Google Photorealistic 3D Tiles does not allow that .*{use}"):
        return choice()


@pytest.mark.parametrize(
    ("more", "use"),
    [
        ('terrain = { height_source = "tiles" }', r'leave out terrain.height_source = "tiles"'),
        ("labels = { enabled = true }", "source other than the service.*labels.enabled"),
    ],
)
def test_settings_are_refused(scene, more, use):
    choice = ShotSource(scene=str(scene(more=more)))
    _refused(lambda: selection.prepare(choice), use)


def test_jobs_are_refused_before_anything_is_fetched(scene, tmp_path):
    choice = ShotSource(scene=str(scene()))
    offline = TileAccess(online=False)
    _refused(lambda: selection.prepare(choice, access=offline), "used offline.*--offline")
    _refused(lambda: selection.prepare(choice, uses=[("pack", "the file")]), "packed")
    for other in (ion.POLICY, google.POLICY):
        settings = choice.settings()
        with pytest.raises(InputError, match=other.name):
            tile_terms.check_source(settings, 1, other, [("pack", "the file")])


def test_each_job_asks(scene, run_folder_of_sample, tmp_path):
    choice = ShotSource(scene=str(scene()), run=str(run_folder_of_sample))
    asked = render.RenderRequest(tmp_path / "film", frames="1", passes="masks")
    _refused(lambda: render.run(choice, asked), 'the pass "masks"')
    asked = render.RenderRequest(tmp_path / "film", frames="1", passes="pose")
    _refused(lambda: render_blend.run(choice, tmp_path / "x.blend", "Scene", asked), 'the pass "pose"')
    _refused(lambda: build.run(choice, tmp_path / "x.blend"), "the .blend file")
    from firetwin.farm import plan

    _refused(lambda: plan.make_job(choice.shot(), scene()), "the farm")
    on_tiles = scene(more='terrain = { height_source = "tiles" }')
    stood = ShotSource(scene=str(on_tiles), run=str(run_folder_of_sample))
    shot = choice.shot()
    shot.settings = stood.settings()
    _refused(lambda: make.run(shot, make.TilesRequest(tmp_path / "set")), "tiles make")
    assert not (tmp_path / "set").exists()


@pytest.fixture(scope="module")
def run_folder_of_sample(tmp_path_factory):
    from firetwin.data import sample

    folder = tmp_path_factory.mktemp("run") / "sample"
    sample.write(folder, 2)
    return folder
