"""Ground below roofs and crowns, on a made scene of known truth: slopes, boxes, crowns and a sharp ridge."""

import numpy as np
import pytest
from firetwin_core import tiles
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

STEP, SIDE = 2.0, 160
Y, X = np.meshgrid(STEP * np.arange(SIDE), STEP * np.arange(SIDE), indexing="ij")
HILLS = 0.4 * X - 0.25 * Y + 12.0 * np.sin(X / 60.0) * np.cos(Y / 75.0)
KNOWN = 0.4 * X - 0.25 * Y + 9.0 * np.sin(X / 60.0) * np.cos(Y / 75.0)  # by a coarser model: 3 m off
BOXES = [(40.0, 60.0, 10.0, 10.0, 5.0), (120.0, 200.0, 40.0, 20.0, 9.0), (220.0, 60.0, 16.0, 50.0, 6.0)]
CROWNS = [(x, y, 12.0, 4.0) for x in (30.0, 38.0, 62.0, 90.0) for y in (130.0, 150.0, 240.0, 290.0)]


def boxes():
    """Find points on roofs, and their level heights above the highest ground below."""
    roof, height = np.zeros(X.shape, bool), np.zeros(X.shape)
    for x, y, wide, long, tall in BOXES:
        inside = (np.abs(X - x) <= wide / 2) & (np.abs(Y - y) <= long / 2)
        roof |= inside
        height[inside] = HILLS[inside].max() + tall
    return roof, height


def crowns():
    """Heights of round crowns on stems, as photogrammetry has them: down to the ground; 0 elsewhere."""
    rng = np.random.default_rng(5)
    height = np.zeros(X.shape)
    for x, y, tall, radius in CROWNS:
        away = np.hypot(X - x, Y - y) / radius
        height = np.maximum(height, tall * np.sqrt(np.clip(1.0 - away**2, 0, None)))
    return height * rng.uniform(0.8, 1.2, X.shape)


def scene(noise=0.1):
    roof, level = boxes()
    growth = crowns()
    surface = np.where(roof, level, HILLS + growth)
    return surface + np.random.default_rng(3).normal(0, noise, X.shape), roof, growth


def test_the_ground_below_boxes_and_crowns():
    surface, roof, growth = scene()
    ground, shown = tiles.find_ground(surface - KNOWN, STEP)
    off = ground + KNOWN - HILLS
    bare = ~roof & (growth == 0.0)
    assert np.abs(off[bare]).max() < 0.5  # the noise of 0.1 m; found: 0.40
    assert np.abs(off[roof]).max() < 0.5  # found: 0.23
    assert np.abs(off[growth > 1.5]).max() < 0.3  # found: 0.14
    assert np.mean(shown[roof] == tiles.BUILDING) > 0.95
    assert np.mean(shown[growth > 1.5] == tiles.VEGETATION) > 0.95
    assert np.mean(shown[bare] == tiles.GROUND) > 0.99
    raised = surface - HILLS
    assert raised[roof].min() > 4.0  # what would stand on roofs without


def test_small_houses_are_told_from_crowns():
    """Houses of 8 m by 6 m with gables of 40 degrees, and conifers and broad crowns, as rough as they are."""
    rng = np.random.default_rng(8)
    house, crown, height = np.zeros(X.shape, bool), np.zeros(X.shape, bool), np.zeros(X.shape)
    for x in range(20, 300, 28):
        for y in range(20, 300, 28):
            across, along = np.abs(X - x), np.abs(Y - y)
            if (x + y) // 28 % 2:
                inside = (across <= 4) & (along <= 3)
                house |= inside
                height[inside] = (3.0 + 0.84 * (4 - across))[inside]
            else:
                radius, power = rng.uniform(2.5, 7), rng.choice([0.5, 1.0])
                part = np.clip(1.0 - np.hypot(across, along) / radius, 0, None) ** power
                crown |= part > 0
                height += rng.uniform(6, 20) * part * rng.uniform(0.8, 1.2, X.shape)
    surface = HILLS + height + rng.normal(0, 0.05, X.shape)
    _, shown = tiles.find_ground(surface - KNOWN, STEP)
    assert np.mean(shown[house] == tiles.BUILDING) > 0.95
    assert np.mean(shown[crown] == tiles.BUILDING) < 0.05


def test_bare_ground_stays_as_it_is():
    ground, shown = tiles.find_ground(HILLS, STEP)
    assert (ground == HILLS.astype(np.float32)).all()
    assert not shown.any()


def test_a_sharp_ridge_is_no_object():
    ridge = HILLS + 30.0 - 0.55 * np.abs(X - 150.0 + 0.3 * Y)
    ground, shown = tiles.find_ground(ridge, STEP)
    assert (ground == ridge.astype(np.float32)).all()
    assert not shown.any()


def test_planes_stay_at_the_border_and_beside_holes():
    plane = 0.8 * X + 0.3 * Y
    plane[60:80, 70:110] = np.nan
    plane[:, 150:] = np.nan
    box = (np.abs(X - 100) <= 8) & (np.abs(Y - 40) <= 8)
    known = 0.7 * X + 0.2 * Y  # a slope of 0.85 alone would hide a box: the ground uphill is higher
    ground, shown = tiles.find_ground(plane + 7.0 * box - known, STEP)
    assert (np.isnan(ground) == np.isnan(plane)).all()
    assert np.nanmax(np.abs(ground + known - plane)) < 1e-3
    assert (shown[box] == tiles.BUILDING).all()


@settings(max_examples=examples(50))
@given(st.integers(0, 10_000))
def test_ground_is_never_above_the_surface(seed):
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(1, 40, 2)
    surface = rng.normal(0, 10, (rows, columns)).astype(np.float32)
    surface[rng.uniform(size=surface.shape) < 0.2] = np.nan
    ground, shown = tiles.find_ground(surface, STEP)
    known = np.isfinite(surface)
    assert (np.isfinite(ground) == known).all()
    assert (ground[known] <= surface[known]).all()
    assert (ground[known & (shown == tiles.GROUND)] == surface[known & (shown == tiles.GROUND)]).all()


def test_numbers_below_0_are_errors():
    with pytest.raises(ValueError, match="step"):
        tiles.find_ground(np.zeros((3, 3)), 0.0)
