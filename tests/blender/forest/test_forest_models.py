"""Models of trees: budgets, sizes, levels of similar look, and an artist's own models."""

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.errors import Error
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import levels, library, models
from firetwin.scene.forest.shape import FOLIAGE

TRIANGLES = ((10_000, 60_000), (1_000, 2_500), (60, 350), (16, 40))  # of living trees, level by level
BRUSH = ((3_000, 6_000), (800, 2_500), (60, 350), (16, 40))
SNAGS = ((100, 1_000), (50, 300), (20, 120), (2, 10))
# Diameter of the crown over the height: conifers in the open are a quarter to a half as wide as tall, black
# oaks about as wide, and the brush is wider than tall (assumed, from the species' descriptions).
WIDTH = {
    "large": (0.25, 0.55),
    "medium": (0.22, 0.50),
    "small": (0.25, 0.65),
    "oak": (0.6, 1.2),
    "brush": (1.0, 3.0),
}
MODELS = models.trees()


@pytest.fixture(scope="module")
def meshes():
    """Every model in every level: points, triangles, materials, colours."""
    return [[model.make(level).mesh() for level in range(levels.LEVELS)] for model in MODELS]


def test_levels_keep_their_budgets(meshes):
    for model, each in zip(MODELS, meshes, strict=True):
        budgets = SNAGS if model.state == "snag" else BRUSH if model.kind == "brush" else TRIANGLES
        for (_, triangles, *_), (low, high) in zip(each, budgets, strict=True):
            assert low <= len(triangles) <= high, model


def test_no_triangle_is_degenerate_and_no_point_unused(meshes):
    for points, triangles, materials, colours in (mesh for each in meshes for mesh in each):
        a, b, c = points[triangles].transpose(1, 0, 2)
        assert np.linalg.norm(np.cross(b - a, c - a), axis=-1).min() > 1e-9
        assert np.array_equal(np.unique(triangles), np.arange(len(points)))
        assert len(materials) == len(triangles)
        assert colours.min() > 0.0
        assert colours.max() < 0.25


def test_models_are_a_metre_tall_and_as_wide_as_their_kind(meshes):
    for model, each in zip(MODELS, meshes, strict=True):
        points, triangles, materials, _ = each[0]
        if model.state == "snag":
            assert 0.8 < points[:, 2].max() <= 1.05
            continue
        assert points[:, 2].max() == pytest.approx(1.0, abs=1e-6)
        leaves = points[np.unique(triangles[materials == FOLIAGE])]
        low, high = WIDTH[model.kind]
        assert low < 2.0 * np.quantile(np.hypot(*leaves[:, :2].T), 0.99) < high, model


def test_no_part_of_a_tree_is_farther_from_its_middle_than_is_said(meshes):
    for model, each in zip(MODELS, meshes, strict=True):
        if model.kind != "brush":
            for points, *_ in each:
                assert np.linalg.norm(points - [0.0, 0.0, 0.5], axis=1).max() <= models.REACH, model
    for shape in models.clumps():
        points = np.concatenate(shape.points) - [0.0, 0.0, 0.5 * forest._GRASS]
        assert np.linalg.norm(points, axis=1).max() <= models.REACH * forest._GRASS


def test_models_are_made_from_their_seeds(meshes):
    for model, each in zip(models.trees(), meshes, strict=True):
        for known, again in zip(each[1:3], (model.make(1).mesh(), model.make(2).mesh()), strict=True):
            assert all(np.array_equal(a, b) for a, b in zip(known, again, strict=True))
    same = [(a, b) for a in range(17) for b in range(a) if len(meshes[a][1][0]) == len(meshes[b][1][0])]
    assert not any(np.array_equal(meshes[a][1][0], meshes[b][1][0]) for a, b in same)


def _triangles(model, level):
    """Lengths (n, 3) of the sides of a model's triangles of foliage, ascending, and their areas (n,)."""
    points, triangles, materials, _ = model.make(level).mesh()
    a, b, c = points[triangles[materials == FOLIAGE]].transpose(1, 0, 2)
    sides = np.stack([np.linalg.norm(one - other, axis=-1) for one, other in ((a, b), (b, c), (c, a))], -1)
    return np.sort(sides, axis=-1), 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1)


def test_conifers_close_by_have_narrow_needles():
    for model in MODELS:
        if model.kind in ("large", "medium", "small") and model.state == "living":
            sides, _ = _triangles(model, 0)
            assert np.median(sides[:, 0] / sides[:, 2]) < 0.27, model


def test_burned_tufts_are_scattered_stalks():
    tufts = [model for model in models.undergrowth() if model.kind == "tuft"]
    area = {state: [] for state in ("living", "snag")}
    for model in tufts:
        points, triangles, *_ = model.make(1).mesh()
        a, b, c = points[triangles].transpose(1, 0, 2)
        area[model.state].append(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1).sum())
    assert max(area["snag"]) < 0.1 * min(area["living"])


BELOW = {  # most triangles of level 0 and 3, least and most width over the height
    "brush": (500, 60, 0.5, 2.5),
    "log": (600, 60, 12.0, 21.0),
    "rock": (2_100, 130, 1.2, 4.0),
    "tuft": (250, 40, 1.0, 2.5),
    "twigs": (400, 80, 5.0, 30.0),
}


@pytest.mark.parametrize("model", models.undergrowth(), ids=lambda model: f"{model.kind}-{model.state}")
def test_what_lies_below_is_a_metre_tall_and_of_few_triangles(model):
    near, far, narrow, wide = BELOW[model.kind]
    meshes_of_level = [model.make(level).mesh() for level in range(levels.LEVELS)]
    counts = [len(triangles) for _, triangles, *_ in meshes_of_level]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] <= near
    assert counts[3] <= far
    for level, (points, triangles, _, colours) in enumerate(meshes_of_level):
        a, b, c = points[triangles].transpose(1, 0, 2)
        assert np.linalg.norm(np.cross(b - a, c - a), axis=-1).min() > 1e-9
        assert np.array_equal(np.unique(triangles), np.arange(len(points)))
        assert colours.max() < 0.25
        again = model.make(level).mesh()
        assert all(
            np.array_equal(one, other) for one, other in zip(meshes_of_level[level], again, strict=True)
        )
    points = meshes_of_level[0][0]
    if (model.kind, model.state) != ("tuft", "snag"):  # stubble is a fifth as tall
        assert (0.7 if model.kind in ("brush", "log") else 0.95) < points[:, 2].max() < 2.4
        assert narrow < np.ptp(points[:, :2], axis=0).max() < wide
    assert -0.5 < points[:, 2].min() < 0.1


def test_smaller_trees_are_drawn_in_coarser_levels():
    assert levels.level(np.array([1e9, 40.0, 39.9, 12.0, 11.9, 4.0, 3.9, 0.0])).tolist() == [
        0,
        0,
        1,
        1,
        2,
        2,
        3,
        3,
    ]


def test_each_tree_is_in_the_level_that_its_nearest_view_asks_for(shot):
    place = shot.paths[0].position[0] + np.array([[0.0, 0.0, -50.0], [0.0, 0.0, -90_000.0]])
    points = {
        "position": place,
        "scale": np.full(2, 20.0),
        "model": np.array([3, 3]),
        "snag_model": np.array([12, 3]),
    }
    seen = library.levelled(shot, points)
    lens = 0.5 * 64 / shot.paths[0].half[0]
    near = levels.level(20.0 * lens / shot.visibility.distance(place))
    assert near[1] == 3 > near[0]
    assert seen["model"].tolist() == [12 + near[0], 15]
    assert seen["snag_model"].tolist() == [48 + near[0], 15]
    wide = library.levelled(shot, points, wider=1.0e4)
    assert wide["model"].tolist() == [
        12,
        12 + levels.level(2.0e5 * lens / shot.visibility.distance(place[1:]))[0],
    ]
    assert wide["model"][1] < 15


def _artist(name, size, **properties):
    """An artist's tree: a box `size` m tall, somewhere."""
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(70.0, -20.0, 5.0))
    thing = bpy.context.object
    thing.name, thing.scale = name, (1.0, 1.0, 0.5 * size)
    bpy.context.view_layer.update()
    collection = bpy.data.collections.get(library.ARTISTS) or bpy.data.collections.new(library.ARTISTS)
    collection.objects.link(thing)
    for key, value in properties.items():
        thing[key] = value
    return thing


def test_an_artists_models_take_the_place_of_their_class(shot, stage, plain_looks):
    fine = _artist("b", 8.0, **{"class": "large", "level": 0})
    fine.data.materials.append(bpy.data.materials.new("theirs"))
    _artist("c", 8.0, **{"class": "large", "level": 2}).modifiers.new("more", "SUBSURF")
    _artist("a", 3.0, **{"class": "small", "state": "snag"})
    _artist("d", 2.0, **{"class": "rock"})
    every = models.every()
    own = next(k for k, model in enumerate(every) if (model.kind, model.state) == ("medium", "living"))
    made = library.tree_models(shot, stage, {int(models.instance(np.array(own), np.array(3)))})
    assert len(made.objects) == len(every) * levels.LEVELS
    for thing in made.objects:
        k, level = map(int, thing.name.split()[2:4])
        theirs = (every[k].kind, every[k].state) in (
            ("large", "living"),
            ("small", "snag"),
            ("rock", "living"),
        )
        if theirs:
            height = np.array([vertex.co for vertex in thing.data.vertices])[:, 2]
            assert len(height) == (26 if every[k].kind == "large" and level >= 2 else 8)
            assert (height.min(), height.max()) == pytest.approx((0.0, 1.0), abs=1e-6)
            if every[k].kind == "large" and level < 2:
                assert thing.data.materials[0].name == "theirs"
        else:
            assert len(thing.data.materials) == (2 if (k, level) == (own, 3) else 0)
    owned.purge()
    assert bpy.data.objects["b"].data.materials[0].name == "theirs"
    assert np.allclose(bpy.data.objects["b"].location, (70.0, -20.0, 5.0))


@pytest.mark.parametrize(
    ("properties", "says"),
    [
        ({"class": "larg"}, "the object \"x\".*class is 'larg'; known are large, medium"),
        ({"class": "oak", "level": 4}, "level is 4; known are 0, 1, 2, 3"),
        ({"class": "oak", "state": "burnt"}, "state is 'burnt'; known are living, snag"),
    ],
)
def test_an_artists_property_that_is_not_known_is_named(shot, stage, properties, says):
    _artist("x", 2.0, **properties)
    with pytest.raises(Error, match=says):
        library.tree_models(shot, stage)


def test_only_models_that_points_draw_have_a_mesh(shot, stage):
    points = {"model": np.array([4, 9, 9, 30]), "snag_model": np.array([4, 50, 50, 50])}
    wanted = library.drawn(points)
    assert {4, 9, 30, 50} <= wanted
    assert {6, 10} <= wanted  # of 4 and 9 the viewport draws level 2
    made = library.tree_models(shot, stage, wanted)
    full = {number for number, thing in enumerate(made.objects) if len(thing.data.vertices)}
    assert full == wanted
    assert len(made.objects) == len(models.every()) * library.LEVELS
