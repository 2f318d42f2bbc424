"""Phenology: leaves by date, latitude and hemisphere, and the models that show it."""

import numpy as np
import pytest
from firetwin.scene.forest import habit, leaf_season, models, phenology
from firetwin.scene.forest.phenology import LeafState
from firetwin.scene.forest.shape import BARK, FOLIAGE, Shape


def test_leaves_turn_and_fall_in_autumn_and_open_in_spring():
    summer, october, december, may = (phenology.in_winter(day, 42.5) for day in (200, 285, 340, 125))
    assert summer == LeafState(0.0, 0.0)
    assert october.turned > 0.5 > 0.2 > october.fallen
    assert december == LeafState(1.0, 1.0)
    assert 0.2 < may.fallen < 0.8
    assert phenology.in_winter(340 - 182.625, -42.5) == pytest.approx(december)


def test_autumn_is_earlier_and_spring_later_near_the_poles():
    assert phenology.in_winter(270, 60.0).turned > phenology.in_winter(270, 45.0).turned
    assert phenology.in_winter(130, 60.0).fallen > phenology.in_winter(130, 45.0).fallen


def test_states_change_day_by_day():
    fallen = np.array([phenology.in_winter(day, 50.0).fallen for day in range(1, 366)])
    assert np.abs(np.diff(fallen)).max() < 0.08
    assert fallen[0] == fallen[-1] == 1.0


def test_evergreens_and_the_dry_season():
    assert phenology.of_kind("", 340, 45.0, 0.0) == LeafState()
    assert phenology.of_kind("drought", 200, -12.0, 0.25).turned == pytest.approx(0.75)


def leaves(shape):
    points, triangles, materials, colours = shape.mesh()
    return points[triangles[materials == FOLIAGE]], colours[triangles[materials == FOLIAGE]][:, 0]


def area(corners):
    return 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )


@pytest.mark.parametrize("level", [0, 3])
def test_a_birch_is_gold_in_october_and_bare_in_december(level):
    birch = models.every()[models.BIRCHES[0]]
    green, gold, bare = (birch.in_season(level, LeafState(*state)) for state in ((0, 0), (1, 0), (1, 1)))
    assert np.array_equal(green.mesh()[0], birch.make(level).mesh()[0])
    tone = leaves(gold)[1].mean(axis=0)
    assert tone[0] > 1.3 * tone[1] > 2.0 * tone[2]
    assert np.array_equal(leaves(gold)[0], leaves(green)[0])
    assert area(leaves(bare)[0]).sum() < 0.35 * area(leaves(green)[0]).sum()
    wood = [(shape.mesh()[2] == BARK).sum() for shape in (green, bare)]
    assert wood[0] == wood[1]


def test_evergreens_do_not_change():
    pine = models.every()[models.STONE_PINES[0]]
    assert np.array_equal(pine.in_season(2, LeafState(1.0, 1.0)).mesh()[3], pine.make(2).mesh()[3])


def test_leaves_turn_one_after_the_other():
    shape, colour = Shape(), habit.BLACK_OAK.colour
    corners = np.random.default_rng(1).uniform(0.0, 1.0, (400, 3, 3))
    shape.leaves(corners, np.broadcast_to(np.array(colour), (400, 3)))
    half = leaf_season.dressed(shape, colour, habit.BLACK_OAK.autumn, LeafState(0.5, 0.0)).mesh()[3]
    red = half[::3, 0]
    assert red.min() < 1.5 * colour[0]
    assert red.max() > 0.8 * habit.BLACK_OAK.autumn[0]
