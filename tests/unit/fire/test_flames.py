"""Flames marched as a volume: height, rise, power, temperature and bounds, on level ground."""

import itertools

import numpy as np
import pytest
from firetwin.scene.fire import flame_volume
from firetwin.scene.fire import flames as points
from firetwin.scene.forest.stand import Stand
from firetwin.shot.fire import flame_library
from firetwin_core import sensor, volume
from flame_field import flames, front
from march_light import NO_LIGHT
from planck import EMPTY, EVERY, KELVINS, PLANCK
from straight_front import shot_of

LIGHT = volume.Illumination(**NO_LIGHT)
OPAQUE = [(18.0, 1.0, 50.0)]  # infrared extinction of 50 1/m
UNBURNT = front(20.0, LENGTH=0.0)


def look(length, away=4.0, wide=64, high=48, elevation=0.0):
    """Parallel rays at a front: origins and directions, and the size of a pixel, m."""
    pixel = 4.0 * length / wide
    across, up = np.meshgrid((np.arange(wide) + 0.5 - wide / 2) * pixel, (np.arange(high) + 0.5) * pixel)
    angle = np.radians(elevation)
    ahead = np.array([0.0, np.cos(angle), -np.sin(angle)])
    upward = np.array([0.0, np.sin(angle), np.cos(angle)])
    origin = across[..., None] * np.array([1.0, 0.0, 0.0]) + up[..., None] * upward - away * length * ahead
    return origin.reshape(-1, 3), np.broadcast_to(ahead, (wide * high, 3)), pixel, (high, wide)


def opacity(burning, length, **view):
    origins, directions, pixel, shape = look(length, **view)
    ends = np.full((len(origins), 1), 8.0 * length)
    found = volume.march([], origins, directions, ends, LIGHT, flames=burning)
    return 1.0 - found[:, 0, 3].reshape(shape), pixel


@pytest.mark.parametrize("length", [1.8, 5.0, 18.0, 30.0])
def test_half_of_the_flames_are_higher_than_their_length(length):
    tops = []
    for time in (3.0, 7.7, 13.1):
        seen, pixel = opacity(flames(front(length), time, pixel=1.0 / 64.0), length)
        tops += [np.flatnonzero(column > 0.5).max(initial=0) * pixel for column in seen.T]
    assert np.median(tops) == pytest.approx(length, rel=0.2)
    assert np.max(tops) < 2.3 * length


def radiated(length, froude):
    """Power (W/m) that a metre of front radiates upwards, from views of both sides at three elevations.

    `froude` is the wind over the root of g and the flame length.
    """
    views, sums, pixel = np.radians([5.0, 35.0, 65.0]), [], length / 8.0
    times, wind = 3.0 + 1.4 * np.sqrt(length) * np.arange(3), (0.0, froude * np.sqrt(9.81 * length))
    for angle in views:
        low, high = -2.2 * np.sin(angle), 1.7 * np.cos(angle) + 2.2 * np.sin(angle)
        up, across = (np.arange(a * length, b * length, pixel) for a, b in ((low, high), (-2.0, 2.0)))
        across, up = (each.ravel() for each in np.meshgrid(across, up + 0.5 * pixel))
        total = 0.0
        for time, side in itertools.product(times, (-1.0, 1.0)):
            ahead = np.array([0.0, side * np.cos(angle), -np.sin(angle)])
            upward = np.array([0.0, side * np.sin(angle), np.cos(angle)])
            origins = across[:, None] * [1.0, 0.0, 0.0] + up[:, None] * upward - 6.0 * length * ahead
            ends = np.minimum(origins[:, 2] / np.sin(angle), 14.0 * length)
            seen = ends > 0.0
            rays = volume.march_infrared(
                [],
                origins[seen],
                np.broadcast_to(ahead, (seen.sum(), 3)),
                ends[seen],
                radiance=EVERY,
                flames=flames(front(length, half=(2.0, 3.0)), time, wind),
                **PLANCK,
                **EMPTY,
            )
            total += rays[:, 0].sum() * pixel**2 / (4.0 * length) / (2 * len(times))
        sums.append(total)
    steps = np.radians(np.arange(0.5, 90.0))
    # A wall that is seen from the side is foreshortened: the mean of |cos| over the azimuth is 2 / pi.
    aside = np.minimum(2.0 / np.pi * np.cos(steps) + np.sin(steps), 1.0)
    return float(
        (2.0 * np.pi * np.interp(steps, views, sums) * aside * np.cos(steps)).sum() * np.radians(1.0)
    )


@pytest.mark.parametrize("length", [0.5, 5.0, 30.0])
def test_radiated_power_is_the_measured_share_of_the_fireline_intensity(length):
    """The mean of calm air, a breeze and wind, as lengths do not tell the wind."""
    intensity = 1000.0 * (length / 0.0266) ** 1.5  # Thomas (1963)
    found = np.mean([radiated(length, froude) for froude in (0.0, 0.41, 0.92)])
    assert found == pytest.approx(flame_volume.RADIATED * intensity, rel=0.15)


def test_temperatures_of_opaque_flames_are_between_the_coolest_and_the_hottest():
    origins, directions, _, _ = look(18.0)
    thick = flames(front(18.0), extinction=OPAQUE)
    found = volume.march_infrared(
        [], origins, directions, np.full(len(origins), 150.0), radiance=EVERY, flames=thick, **PLANCK, **EMPTY
    )
    opaque = found[found[:, 1] < 1e-3, 0]
    kelvin = (np.pi * opaque / 5.670374e-8) ** 0.25
    low, high = flame_volume.KELVIN
    assert len(kelvin) > 100
    assert np.all((kelvin > low - 1.0) & (kelvin < high + 1.0))
    assert np.ptp(kelvin) > 200.0


@pytest.mark.parametrize("band", [(8.0, 14.0), (3.4, 4.1)])
def test_opaque_flames_of_one_temperature_have_its_planck_radiance(band):
    origins, directions, _, _ = look(18.0)
    even = flames(front(18.0), extinction=OPAQUE, coolest=1150.0, hottest=1150.0)
    table, ends = sensor.radiance(KELVINS, band), np.full(len(origins), 150.0)
    found = volume.march_infrared(
        [], origins, directions, ends, radiance=table, flames=even, **PLANCK, **EMPTY
    )
    opaque = found[found[:, 1] < 1e-3, 0]
    assert len(opaque) > 100
    assert opaque == pytest.approx(float(sensor.radiance(1150.0, band)), rel=0.02)


def test_the_pattern_rises_with_the_gas():
    length, rate, frames = 25.0, 12.0, 4
    origins, directions, pixel, shape = look(length, wide=160, high=64)
    ends, seen = np.full((len(origins), 1), 200.0), []
    for number in range(frames):
        burning = flames(front(length), 3.0 + number / rate, pixel=1.0 / 160.0)
        found = volume.march([], origins, directions, ends, LIGHT, flames=burning)
        seen.append(np.log(np.maximum(found[:, 0, :3], 0.0).sum(axis=-1).reshape(shape) + 3e-2))
    seen = np.array(seen)
    seen -= seen.mean(axis=(0, 2))[None, :, None]  # flames are brightest at their foot, at any time
    block = flame_library.load("calm")
    rows = slice(int(0.3 * length / pixel), int(0.9 * length / pixel))
    likeness = []
    for shift in range(5):
        later = slice(rows.start + shift, rows.stop + shift)
        pairs = [(a[rows], b[later]) for a, b in itertools.pairwise(seen)]
        likeness.append(np.mean([np.corrcoef(a.ravel(), b.ravel())[0, 1] for a, b in pairs]))
    best = int(np.argmax(likeness))
    assert best > 0
    before, at, after = likeness[best - 1 : best + 2]
    shift = best + 0.5 * (before - after) / (before - 2.0 * at + after)
    gas = block.rise[int(0.3 / block.cell) : int(0.9 / block.cell)].mean() * np.sqrt(9.81 * length)
    # The tips and the foot of a flame stay where they are, so the pattern lags behind the gas.
    assert 0.4 < shift * pixel * rate / gas < 1.2
    assert at > 0.8


def test_wind_does_not_comb_flames_into_strokes():
    length = 8.0
    burning = flames(front(length), wind=(0.0, 4.0))
    origins, directions, _, shape = look(length, wide=160, high=60)
    found = volume.march([], origins, directions, np.full((len(origins), 1), 64.0), LIGHT, flames=burning)
    seen = np.log(np.maximum(found[:, 0, :3], 0.0).sum(axis=-1).reshape(shape) + 0.1)
    up, across = (slope[10:40] for slope in np.gradient(seen))
    steep, level, both = (up**2).mean(), (across**2).mean(), (up * across).mean()
    aligned = np.hypot(steep - level, 2.0 * both) / (steep + level)  # 1: all strokes are parallel
    assert aligned < 0.28


def test_a_still_front_does_not_slide():
    """A front of four lengths, which ends at both sides."""
    length, centres = 8.0, []
    burning = front(length, spacing=0.5, LENGTH=lambda x, y: length * (np.abs(x) < 2.0 * length))
    for time in np.arange(0.0, 40.0, 2.0):
        seen, pixel = opacity(flames(burning, time), length, wide=48, high=6)
        across = (np.arange(seen.shape[1]) + 0.5 - seen.shape[1] / 2) * pixel
        centres.append((seen * across).sum() / seen.sum())
    early, late = np.mean(centres[:10]), np.mean(centres[10:])
    assert abs(early) < 0.1 * length
    assert abs(late - early) < 0.1 * length


def test_nothing_burns_outside_of_the_patches():
    nodes, corners, spacings = front(5.0)
    east = corners[:, 0] > -1.0
    burning = flames((nodes[east], corners[east], spacings[east]), wind=(4.0, 0.0))
    heights = np.linspace(0.1, 6.0, 40)
    for x, dark in ((-0.1, True), (3.0, False)):
        origins = np.column_stack([np.full(40, x), np.full(40, -100.0), heights])
        found = volume.march(
            [], origins, np.tile((0.0, 1.0, 0.0), (40, 1)), np.full((40, 1), 300.0), LIGHT, flames=burning
        )
        assert np.all(found[:, 0, 3] == 1.0) == dark
    below = volume.march([], [1.0, 0.0, -5.0], [[0.0, 0.0, -1.0]], [[100.0]], LIGHT, flames=burning)
    assert below[0, 0, 3] == 1.0


@pytest.mark.parametrize("pixel", [0.0, 1e-7, 10.0])
def test_places_without_flames_beside_flames_are_clear(pixel):
    """Heights over lengths of nothing exceed all indices of a block."""
    patches = front(1.7, LENGTH=lambda x, y: np.where(x < 0.0, 0.0, 1.7))
    burning = flames(patches, pixel=pixel, origin=(0.0, 3.0, 0.5))
    ahead = np.column_stack([np.linspace(-0.5, 0.5, 400), np.full(400, -1.0), np.tile([0.0, 0.2], 200)])
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    seen = volume.march([], (0.0, 3.0, 0.5), ahead, np.full((400, 1), 20.0), LIGHT, flames=burning)
    assert np.isfinite(seen).all()
    assert np.isfinite(burning.sample(np.column_stack([np.linspace(-9.0, 9.0, 99)] * 3))).all()


def test_values_of_no_place_are_refused():
    nodes, corners, spacings = front(1.7)
    nodes[0, 3, 3, 1] = np.nan
    with pytest.raises(ValueError, match="finite"):
        flames((nodes, corners, spacings))


def test_surfaces_cut_flames_and_smoke_dims_them():
    origins, directions = np.array([[0.0, -60.0, 2.0]]), np.array([[0.0, 1.0, 0.0]])
    ends = [[30.0, 57.0, 120.0]]
    burning = flames(front(18.0))
    alone = volume.march([], origins, directions, ends, LIGHT, flames=burning)[0]
    assert alone[0, 3] == 1.0  # a surface before the flames
    assert alone[0, 3] > alone[1, 3] >= alone[2, 3]
    assert alone[1, 3] > 0.0
    fields = dict.fromkeys(("fresh", "sun", "sky", "glow"), np.zeros((9, 9, 9)))
    smoke = volume.Bricks(np.full((9, 9, 9), 0.05), **fields, voxel_size=4.0, origin=(-16.0, -56.0, -16.0))
    both = volume.march([smoke], origins, directions, ends, LIGHT, 0.5, 1e-7, burning)[0]
    before = both[0, 3]
    assert before == pytest.approx(np.exp(-0.05 * 26.0), rel=0.01)
    assert both[1, 3] == pytest.approx(np.exp(-0.05 * 31.0) * alone[1, 3], rel=0.2)
    assert both[1, :3] == pytest.approx(np.exp(-0.05 * 31.0) * alone[1, :3], rel=0.2, abs=5e-4)


def test_smoke_begins_outside_of_flames():
    """A flame's own soot glows: smoke in the same place dims only what is between its tongues."""
    origins, directions = np.array([[0.0, -60.0, 2.0]]), np.array([[0.0, 1.0, 0.0]])
    burning, ends = flames(front(18.0), extinction=[(18.0, 1e-3, 1.0)]), [[120.0]]
    alone = volume.march([], origins, directions, ends, LIGHT, flames=burning, parts=True)[0, 0]
    fields = dict.fromkeys(("fresh", "sun", "sky", "glow"), np.zeros((9, 9, 9)))
    smoke = volume.Bricks(np.full((9, 9, 9), 0.05), **fields, voxel_size=4.0, origin=(-16.0, -16.0, -16.0))
    both = volume.march([smoke], origins, directions, ends, LIGHT, 0.5, 1e-7, burning, parts=True)[0, 0]
    clear = -np.log(both[7]) / 0.05  # m of smoke that are left of 32
    assert 32.0 - 9.0 < clear < 32.0 - 1.0
    assert both[4] < alone[4]


def test_frames_repeat_bit_for_bit_in_any_order_of_rays():
    origins, directions, _, _ = look(5.0)
    ends = np.full((len(origins), 1), 40.0)

    def picture(rows=slice(None)):
        burning = flames(front(5.0), 1.0e5, pixel=1.0 / 64.0)
        return volume.march([], origins[rows], directions[rows], ends[rows], LIGHT, flames=burning)

    first, some = picture(), np.random.default_rng(1).permutation(len(origins))[:1000]
    assert np.array_equal(first, picture())
    assert np.array_equal(first[some], picture(some))


def test_a_ray_meets_the_same_flames_wherever_it_starts():
    """Steps over empty ground skip no flames."""
    burning = flames(front(12.0, half=(5.0, 15.0), spacing=8.0), wind=(3.0, 1.0))
    across = np.linspace(-60.0, 60.0, 200)
    ends = np.column_stack([across, np.full(200, 25.0), np.full(200, 1.0)])
    ahead = np.array([0.0, 1.0, -0.15]) / np.hypot(1.0, 0.15)
    seen = []
    for back in (180.0, 163.3, 141.7, 125.0):
        origins, reach = ends - back * ahead, np.full((200, 1), back)
        seen.append(
            volume.march([], origins, np.tile(ahead, (200, 1)), reach, LIGHT, flames=burning)[:, 0, 3]
        )
    assert np.mean(seen[0] < 0.9) > 0.3
    assert max(np.abs(each - seen[0]).mean() for each in seen[1:]) < 0.02


def test_a_crown_in_flames_is_as_wide_as_the_tree_over_its_trunk():
    crown = np.array([[0.0, 0.0, 0.0, 4.0, 28.0, 3.0]])
    rows, pixel = [], 0.0
    for time in (3.0, 7.7, 13.1):
        seen, pixel = opacity(flames(UNBURNT, time, spindles=crown), 20.0)
        rows.append((seen > 0.3).sum(axis=1) * pixel)
    wide = np.mean(rows, axis=0)
    middle = slice(int(6.0 / pixel), int(14.0 / pixel))
    assert 2.0 < wide[middle].mean() < 8.0
    assert wide[: int(1.5 / pixel)].max() < 0.5 * wide[middle].mean()
    assert 14.0 < np.flatnonzero(wide).max() * pixel < 36.0


def test_a_crown_burns_upright_at_its_middle():
    crown = np.array([[0.0, 0.0, 0.0, 4.0, 24.0, 3.2]])
    seen, pixel = opacity(flames(UNBURNT, spindles=crown, wind=(3.0, 0.0)), 18.0)
    across = (np.arange(seen.shape[1]) + 0.5 - seen.shape[1] / 2) * pixel
    rows = slice(int(6.0 / pixel), int(10.0 / pixel))
    assert abs((seen[rows] * across).sum() / seen[rows].sum()) < 2.0
    tops = np.flatnonzero(seen.max(axis=1) > 0.5)
    assert 18.0 < (tops.max() + 1) * pixel < 36.0  # the upper edge of the row


def test_the_light_of_flames_is_apart_from_smoke():
    origins, directions, _, _ = look(5.0)
    ends = np.full((len(origins), 1), 40.0)
    burning = flames(front(5.0), 3.0)
    found = volume.march([], origins, directions, ends, LIGHT, flames=burning, parts=True)[:, 0]
    assert found[:, 0].max() > 0.0
    assert np.array_equal(found[:, 4:7], found[:, :3])
    assert np.all(found[:, 7] == 1.0)
    assert found[:, 3].min() < 1.0


def wood(shot, width=1.0):
    """Stand of a tree of 20 m every 4 m."""
    line = np.arange(-200.0, 200.0, 4.0)
    place = np.stack([*np.meshgrid(line, line), np.zeros((len(line), len(line)))], axis=-1).reshape(-1, 3)
    count = len(place)
    key = np.stack([np.arange(count), np.full(count, 7)], axis=-1)
    every, zeros = np.full(count, 20.0), np.zeros(count)
    return Stand(place, every, np.full(count, width), zeros.astype(np.float32), key[:, 0], key, zeros, 1000.0)


def test_crowns_torch_in_groups_and_as_wide_as_their_trees(make_run):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    torches = points.torching_crowns(shot, wood(shot))
    rows = np.zeros((100, 100), bool)
    rows[*np.rint(torches.position[:, :2] / 4.0 + 50.0).astype(int).T] = True
    share = rows.mean()
    assert share == pytest.approx(0.8 * 0.5, abs=0.08)  # of dense canopies, by canopy fuel
    beside = (rows[:, 1:] & rows[:, :-1]).sum() / rows[:, :-1].sum()
    assert beside > 0.5 * (1.0 + share)  # single trees would burn beside a share of the others alone
    wide = points.torching_crowns(shot, wood(shot, 2.5))
    assert wide.width == pytest.approx(2.5 * torches.width)
    time = float(np.median(torches.arrival_time)) + 15.0
    slim, broad = (flame_volume.spindles(each, time, np.zeros(3)) for each in (torches, wide))
    assert len(slim) > 20
    assert broad[:, 5] == pytest.approx(2.5 * slim[:, 5])


def test_trees_in_tall_flames_of_the_front_burn_with_it_and_briefly(make_run, monkeypatch):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    tall = points.torching_crowns(shot, wood(shot))
    monkeypatch.setattr(points.flame_state, "even_length", lambda _shot, row, _column: np.zeros(len(row)))
    alone = points.torching_crowns(shot, wood(shot))
    assert tall.position == pytest.approx(alone.position)
    assert np.median(tall.residence) == pytest.approx(0.4 * np.median(alone.residence), rel=0.05)
    assert np.median(alone.arrival_time - tall.arrival_time) == pytest.approx(10.0, abs=1.5)


def test_distant_crowns_fade_into_the_front(make_run):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    torches = points.torching_crowns(shot, wood(shot))
    time = float(np.median(torches.arrival_time)) + 15.0
    tops = [
        flame_volume.spindles(torches, time, np.array((0.0, -away, 0.0)))[:, 4].sum()
        for away in (1500.0, 2250.0, 3000.0)
    ]
    assert tops[0] > tops[1] > 0.0
    assert tops[2] == 0.0
