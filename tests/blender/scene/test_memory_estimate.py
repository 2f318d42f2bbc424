"""The memory estimate of a render: its parts and their sizes."""

from dataclasses import replace

import pytest
from firetwin.render import memory_estimate
from firetwin.shot.shot import Shot
from firetwin.smoke.flow import Flow


def _smoky(settings, **smoke):
    return replace(settings, smoke=replace(settings.smoke, enabled=True, spin_up=60.0, **smoke))


def test_what_is_drawn_is_counted(shot, built):
    load = memory_estimate.load(shot, built)
    assert load.pixels == 64 * 36
    (grass,) = (each for each in built.objects_of("Forest") if each.name == "Firetwin Grass")
    (trees,) = (each for each in built.objects_of("Forest") if each.name == "Firetwin Trees")
    assert len(trees.data.vertices) > 100
    assert load.plants == len(grass.data.vertices) + len(trees.data.vertices), "not trees of the viewport"
    assert load.faces >= len(built.objects_of("Terrain")[0].data.polygons)
    assert (load.cells, load.voxels, load.layered) == (0, 0, 0)
    assert memory_estimate.load(shot, built, names=("rgb", "comp")) == replace(load, layered=64 * 36)


def test_what_is_hidden_is_not_counted(shot, built):
    whole = memory_estimate.load(shot, built)
    (trees,) = (each for each in built.objects_of("Forest") if each.name == "Firetwin Trees")
    trees.hide_render = True
    assert memory_estimate.load(shot, built).plants == whole.plants - len(trees.data.vertices)


def test_cells_count_until_all_moments_are_kept(settings, run, few_cells, built, monkeypatch):
    shot = Shot(_smoky(settings), run)
    parts = Flow(shot).domains
    load = memory_estimate.load(shot, built, [1, 2])
    assert len(parts) == 2
    assert load.cells == sum(
        len(part.ground) * len(part.ground[0]) * (len(part.box.levels) - 1) for part in parts
    )
    assert load.voxels > 0
    kept = {1}
    monkeypatch.setattr("firetwin.smoke.domains.Domain.has", lambda part, frame: frame in kept)
    assert memory_estimate.load(shot, built, [1, 2]).cells == load.cells
    kept.add(2)
    assert memory_estimate.load(shot, built, [1, 2]) == replace(load, cells=0)


def test_nothing_is_said_of_smoke_that_cycles_holds(settings, run, built):
    shot = Shot(_smoky(settings, draw="volume"), run)
    assert memory_estimate.load(shot, built, [1]) is None
    assert memory_estimate.load(shot, built, []) is not None, "where no picture shows it"


@pytest.mark.parametrize(
    ("what", "each"),
    [("pixels", 790), ("layered", 200), ("plants", 2550), ("faces", 255), ("cells", 0), ("voxels", 7)],
)
def test_each_of_it_adds_to_the_memory(what, each):
    some = memory_estimate.Load(
        pixels=230_400, plants=188_000, faces=853_000, cells=3_200_000, voxels=130_000_000
    )
    more = replace(some, **{what: getattr(some, what) + 1_000_000})
    assert more.bytes - some.bytes == each * 1_000_000


def test_the_solver_has_a_process_of_its_own():
    some = memory_estimate.Load(pixels=0, plants=0, faces=0, cells=1_000_000)
    assert some.solver == 0.3e9 + 175 * 1_000_000
    assert replace(some, cells=0).solver == 0


def test_it_is_told_in_words():
    load = memory_estimate.Load(pixels=230_400, plants=100_000, faces=0, cells=2_000_000)
    assert memory_estimate.describe(load) == (
        "rendering takes about 1.2 GB of memory at most, and 650 MB while the smoke's flow is solved"
    )
    assert memory_estimate.describe(replace(load, cells=0)).endswith("1.2 GB of memory at most")
