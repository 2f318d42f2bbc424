"""Flames of a front at any size of pixels and at any time: equal light, no dots, no jumps and no repeats."""

import itertools

import numpy as np
import pytest
from firetwin.shot.fire import flame_library
from firetwin_core import volume
from flame_field import flames, front
from march_light import NO_LIGHT

LIGHT = volume.Illumination(**NO_LIGHT)
LENGTH, AWAY, UP, HALF = 10.0, 1500.0, 150.0, 0.1  # m, and half of the width of the picture over the distance


def far_view(wide):
    """Red light (h, w) of a front from afar, in a picture of this width with 4 rays in each pixel."""
    high, size = wide * 9 // 16, 2.0 * HALF / wide
    rays = 2 if wide < 640 else 1  # along a side
    x, z = np.meshgrid(
        (np.arange(rays * wide) + 0.5) * size / rays - HALF,
        (rays * high / 2 - np.arange(rays * high) - 0.5) * size / rays,
    )
    directions = np.stack([x, np.ones_like(x), z - UP / AWAY], axis=-1).reshape(-1, 3)
    slant = np.linalg.norm(directions, axis=-1, keepdims=True)
    origin = np.array([0.0, -AWAY, UP])
    burning = flames(
        front(LENGTH, half=(16.0, 3.0), SHARE=lambda x, y: 0.5 + 0.5 * np.sign(np.sin(0.07 * x))),
        pixel=size,
        origin=origin,
    )
    reach = (slant / np.maximum(-directions[:, 2:], 1e-6)) * UP
    found = volume.march(
        [], origin, directions / slant, np.minimum(reach, 3000.0), LIGHT, flames=burning, pixel=(0.0, size)
    )
    return found[:, 0, 0].reshape(high, rays, wide, rays).mean(axis=(1, 3))


@pytest.fixture(scope="module")
def resolved():
    """Mean light in a picture of 640 x 360 pixels."""
    return far_view(640).mean()


@pytest.mark.parametrize("wide", [32, 96])
def test_pixels_of_any_size_show_the_light_of_a_distant_front(wide, resolved):
    assert far_view(wide).mean() == pytest.approx(resolved, rel=0.1)


def test_a_distant_front_has_no_dots():
    """No pixel of the line is over three times as bright as its neighbours along it."""
    seen = far_view(96)
    line = seen.max(axis=0)
    beside = 0.5 * (line[:-2] + line[2:])
    lit = beside > 0.2 * line.max()
    assert lit.sum() > 30
    assert (line[1:-1][lit] < 3.0 * beside[lit]).all()


def near_view(time=3.0, length=LENGTH, wind=0.0, left=0.0, wide=48, high=24, part=1.0, pixel=1e-3):
    """Red light (h, w) of a front in parallel rays, four lengths times `part` wide, from `left` m along it.

    `pixel` is the size that pixels are said to have, over their distance.
    """
    size = part * 4.0 * LENGTH / wide
    across, up = np.meshgrid(left + (np.arange(wide) + 0.5) * size, (np.arange(high) + 0.5) * size)
    origins = np.stack([across, np.full_like(up, -4.0 * LENGTH), up], axis=-1).reshape(-1, 3)
    ahead = np.broadcast_to([0.0, 1.0, 0.0], origins.shape)
    burning = flames(front(LENGTH, half=(60.0, 3.0), LENGTH=length), time, (0.0, wind), pixel=pixel)
    found = volume.march([], origins, ahead, np.full((len(origins), 1), 8.0 * LENGTH), LIGHT, flames=burning)
    return found[:, 0, 0].reshape(high, wide)


def test_near_flames_have_folds_that_are_smaller_than_cells_of_the_solved_fire():
    """Pixels of a quarter of a cell show them, and pixels of a cell the same light without them."""
    fine, cells = (near_view(wide=160, high=64, part=0.2, pixel=pixel) for pixel in (1e-3, 4.6e-3))

    def folds(seen):
        return np.abs(seen[:, 2:] - 2.0 * seen[:, 1:-1] + seen[:, :-2]).mean() / seen.mean()

    assert folds(fine) > 1.12 * folds(cells)
    assert fine.mean() == pytest.approx(cells.mean(), rel=0.12)


def steps(pictures):
    """Mean differences of successive pictures."""
    return np.array([np.abs(b - a).mean() for a, b in itertools.pairwise(pictures)])


def test_frames_follow_one_another_without_a_jump_at_the_seam_of_the_loop():
    block = flame_library.load("calm")
    loop = len(block.codes) * block.interval * np.sqrt(LENGTH / 9.81)
    change = steps([near_view(time) for time in np.arange(0.7 * loop, 1.2 * loop, 1.0 / 24.0)])
    assert change.min() > 0.0
    assert change.max() < 2.0 * np.median(change)


@pytest.mark.parametrize(
    ("name", "values"),
    [("length", np.geomspace(5.0, 13.0, 41)), ("wind", np.linspace(0.0, 12.0, 41))],
)
def test_flames_change_evenly_with_length_and_wind(name, values):
    """Neither where the pattern doubles nor where another solved fire begins."""
    change = steps([near_view(wide=32, high=16, **{name: value}) for value in values])
    assert change.max() < 0.15 * change.sum()


def test_a_front_repeats_neither_over_500_m_nor_over_30_s():
    tops = []
    for time in np.arange(0.0, 31.0, 6.0):
        line = np.concatenate(
            [near_view(time, left=left, high=12).mean(axis=0) for left in np.arange(-250.0, 250.0, 40.0)]
        )
        tops.append(line - line.mean())
    tops = np.array(tops)
    width = 36  # 30 m
    first = tops[0][:width]
    scores = [
        np.corrcoef(first, line[at : at + width])[0, 1]
        for number, line in enumerate(tops)
        for at in range(len(line) - width)
        if number > 0 or at > width
    ]
    assert np.max(scores) < 0.9


def leading_edge(left, wide=80, deep=60):
    """Places (wide,) of the edge of a front from above, within its lowest 0.15 lengths, in flame lengths."""
    along, across = np.meshgrid(
        left + (np.arange(wide) + 0.5) * 4.0 * LENGTH / wide, (np.arange(deep) / deep - 0.5) * 2.4 * LENGTH
    )
    origins = np.stack([along, across, np.full_like(along, 0.15 * LENGTH)], axis=-1).reshape(-1, 3)
    down = np.broadcast_to([0.0, 0.0, -1.0], origins.shape)
    burning = flames(front(LENGTH, half=(60.0, 3.0)), pixel=1e-3)
    found = volume.march([], origins, down, np.full((len(origins), 1), 0.14 * LENGTH), LIGHT, flames=burning)
    lit = found[:, 0, 0].reshape(deep, wide) > 0.1
    return across[np.argmax(lit, axis=0), 0][lit.any(axis=0)] / LENGTH


def test_the_edge_of_a_front_is_no_straight_line():
    spread = np.mean([np.std(leading_edge(left)) for left in (0.0, 50.0, 100.0)])
    assert 0.1 < spread < 0.2
