"""Detail below a flow's cells: it moves with the air, stays in smoke, and is equal on any threads."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import flow
from flow_moments import DEPTH, SPACING, VOXEL, N, moment
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples


def in_wind(wind=(6.0, -3.0), period=120.0):
    """A solver in a steady uniform wind, and its drift."""
    levels = np.arange(11) * DEPTH
    profile = flow.Profile([0.0, 2000.0], [300.0, 306.0], [wind] * 2)
    settings = flow.SolverSettings(sponge_width=3)
    solver = flow.Solver(flow.Domain(levels, (N, N), SPACING), profile, settings)
    solver.set_sources(np.empty((0, 2)), [], [])
    return solver, flow.Drift(solver, period)


def painted(origin=(0.0, 0.0, 0.0), share=1.0, surface=0.0, count=48, wanted=None, **changed):
    plane = np.ones((count, count))
    detail = flow.Detail(**moment(**changed))
    return detail.paint(origin, VOXEL, surface * plane, share * plane, 40, wanted)


@settings(max_examples=8, deadline=None)
@given(st.floats(-9, 9), st.floats(-9, 9), st.sampled_from([3.0, 7.0, 11.0]))
def test_in_a_steady_wind_air_drifts_with_it(east, north, dt):
    solver, drift = in_wind((east, north), period=100.0)
    for _ in range(6):
        solver.step(dt)
        drift.advance()
        since = (solver.time + np.array([0.0, 50.0])) % 100.0
        since = np.minimum(since, solver.time)
        middle = drift.values()[1:4, 2:4, 2:4]
        late = since < dt  # a phase that began within the step begins at its end
        expected = np.where(late, 0.0, since)
        began = np.where(late, 0.0, since) % dt  # what of a step went by before it began
        wind = np.array([east, north, 0.0])
        error = np.abs(middle - expected[:, None] * wind)
        assert error.max() <= (began.max() + 1e-3) * max(abs(east), abs(north)) + 0.2
    assert np.sum(np.square(drift.weights)) == pytest.approx(1.0, abs=1e-6)


def test_a_phase_is_unseen_when_it_begins_anew():
    solver, drift = in_wind(period=40.0)
    for _ in range(12):
        before = drift.turns
        solver.step(10.0)
        drift.advance()
        for weight, old, new in zip(drift.weights, before, drift.turns, strict=True):
            assert old == new or weight < 1e-3


def test_going_on_from_kept_drift_is_going_on():
    solver, drift = in_wind()
    solver.step(10.0, 2)
    drift.advance()
    again = flow.Drift(solver)
    again.restore(drift.time, drift.values())
    solver.step(10.0)
    drift.advance()
    again.advance()
    assert np.array_equal(again.values(), drift.values())
    assert again.turns == drift.turns


def test_detail_goes_where_the_air_has_gone():
    """The same noise, in smoke that is the same everywhere: moved by the drift, and by nothing else."""
    even = {"smoke": np.full((N, N, N), 2e-7)}
    still = painted(**even)[0]
    moved = painted(**even, drift=np.broadcast_to([8 * VOXEL, -4 * VOXEL, 0.0], (N, N, N, 2, 3)))[0]
    inside = slice(14, 34)
    assert still[inside, inside, 8:30].std() > 0.0
    there = moved[22:42, 10:30, 8:30]
    assert np.allclose(there, still[inside, inside, 8:30], rtol=2e-3, atol=1e-7)


def test_another_turn_of_a_phase_has_other_noise():
    assert not np.array_equal(painted()[0], painted(turns=(1, 0))[0])


def test_any_number_of_threads_paints_the_same(all_threads):
    found = []
    for threads in (1, 3):
        core.set_threads(threads)
        found.append(painted(temperature_excess=np.full((N, N, N), 2.0), glow=np.ones((N, N, N))))
    for one, three in zip(*found, strict=True):
        assert np.array_equal(one, three)


def test_a_part_of_a_brick_is_painted_as_in_the_whole():
    lively = {"temperature_excess": np.full((N, N, N), 2.0), "age": np.full((N, N, N), 100.0)}
    whole = painted(**lively)
    part = painted(origin=(12 * VOXEL, 20 * VOXEL, 0.0), count=16, **lively)
    for one, other in zip(whole[:2], part[:2], strict=True):
        assert other.max() > 0.0
        assert np.array_equal(one[12:28, 20:36], other)


def test_blocks_that_nobody_wants_stay_empty():
    young = {"age": np.full((N, N, N), 100.0)}
    whole = painted(**young)
    wanted = np.zeros((3, 3, 3), bool)
    wanted[1, 1, 1] = wanted[2, 0, 2] = True
    some = painted(wanted=wanted, **young)
    there = np.kron(wanted, np.ones((16, 16, 16), bool))[:, :, :40]
    for one, other in zip(whole[:2], some[:2], strict=True):
        assert other[there].max() > 0.0
        assert np.array_equal(np.where(there, one, 0.0), other)


@pytest.mark.parametrize("west", [False, True])
def test_cells_far_away_change_nothing(west):
    """More of the same to a side; rows of cells are then long enough to be filtered many at a time."""
    rng = np.random.default_rng(3)
    fields = moment(
        age=rng.uniform(0.0, 900.0, (N, N, N)),
        temperature_excess=rng.uniform(0.0, 1.0, (N, N, N)),
        drift=rng.uniform(-200.0, 200.0, (N, N, N, 2, 3)),
        blur=(1.5, 1.0, 0.7),
    )

    def among(columns, west):
        """Painted where these cells are the last or, with none to the west, the first of so many columns."""
        first = columns - N if west else 0
        place = np.clip(np.arange(columns) - first, 0, N - 1)
        names = ("heights", "smoke", "age", "rise", "temperature_excess", "drift")
        wide = {name: fields[name].take(place, axis=2) for name in names}
        more = {"ground": np.zeros((N, columns)), "corner": (-first * SPACING, 0.0)}
        return painted(**fields | wide | more)

    for one, other in zip(among(2 * N, west)[:2], among(3 * N, west)[:2], strict=True):
        assert one[40:].max() > 0.0
        assert np.array_equal(one, other)


@settings(max_examples=examples(25), deadline=None)
@given(
    cells=st.lists(st.tuples(*(st.integers(0, N - 1),) * 3), min_size=1, max_size=6),
    slope=st.floats(-0.3, 0.3),
    wanted=st.booleans(),
)
def test_all_smoke_is_found_and_nothing_else(cells, slope, wanted):
    """Also in layers with clear air between them, at the ground and at the top."""
    smoke = np.zeros((N, N, N))
    for cell in cells:
        smoke[cell] = 1e-6
    middle = (np.arange(N) + 0.5) * SPACING
    ground = np.broadcast_to(slope * middle, (N, N))
    blocks = np.random.default_rng(len(cells)).random((3, 3, 3)) < 0.5 if wanted else None
    fresh = painted(
        smoke=smoke,
        age=np.zeros((N, N, N)),
        ground=ground,
        heights=moment()["heights"] + ground,
        surface=0.0,
        wanted=blocks,
    )[1]
    x = np.arange(48) * VOXEL
    east = np.clip(x / SPACING - 0.5, 0.0, N - 1.0)
    higher = np.interp(east, np.arange(N), -ground[0])
    levels = moment()["levels"]
    amount = np.log(np.maximum(smoke / 1e-9, 1.0))
    for i in range(2, 46, 3):
        a = min(int(east[i]), N - 2)
        column = amount[:, :, a] + (amount[:, :, a + 1] - amount[:, :, a]) * (east[i] - a)
        heights = levels + np.interp(east[i], np.arange(N), ground[0]) + higher[i] * np.exp(-levels / 1000.0)
        z = np.arange(40) * VOXEL
        level = np.interp(z, heights, np.arange(N))
        for j in range(2, 46, 5):
            b = min(int(east[j]), N - 2)
            here = np.interp(
                level, np.arange(N), column[:, b] + (column[:, b + 1] - column[:, b]) * (east[j] - b)
            )
            there = (here >= 1.2) & (z >= -VOXEL) & (z <= heights[-1])
            if blocks is not None:
                there &= blocks[i // 16, j // 16].repeat(16)[:40]
            sure = (np.abs(here - 1.2) > 1e-3) & (np.abs(z - heights[-1]) > 1e-2)
            assert np.array_equal((fresh[i, j] > 0.0)[sure], there[sure])


def test_vapour_makes_rising_smoke_white_and_thicker_from_its_height_on():
    young = {"age": np.full((N, N, N), 60.0), "rise": np.full((N, N, N), 5.0), "max_extinction": 1.0}
    below, above = slice(4, 16), slice(28, 32)  # condensation at 600 m, cloud from 1100 m on
    without, cloudy = painted(**young), painted(condensation_height=100.0, **young)
    middle = painted(condensation_height=600.0, **young)
    there = without[0] > 1e-3
    assert there[:, :, above].any()
    assert np.all(
        cloudy[0][:, :, above][there[:, :, above]] > 2.0 * without[0][:, :, above][there[:, :, above]]
    )
    assert without[1][:, :, above][there[:, :, above]].min() > 0.5
    assert cloudy[1][:, :, above][there[:, :, above]].max() < 1e-6
    for with_none, with_it in zip(without[:2], middle[:2], strict=True):
        assert np.array_equal(with_none[:, :, below], with_it[:, :, below])


def test_calm_old_smoke_makes_no_cloud():
    thin = {"smoke": np.full((N, N, N), 1e-7), "age": np.full((N, N, N), 3600.0)}
    without = painted(**thin)[0]
    assert without.max() > 0.0
    assert np.array_equal(painted(condensation_height=0.0, **thin)[0], without)


def test_thin_rising_smoke_is_not_torn_to_pieces():
    """A layer of uniform density has no holes."""
    z = np.arange(N)[:, None, None] - 5.0
    layer = 1e-9 * np.exp(np.broadcast_to(6.6 - z**2, (N, N, N)))
    density = painted(smoke=layer, rise=np.full((N, N, N), 5.0))[0]
    column = density[8:40, 8:40].max(axis=2)
    assert np.mean(column > 1e-3) > 0.85


def test_thin_plumes_are_translucent_and_thick_ones_are_not():
    """Both rise; upper quartiles of what shows, as outlines are thin in both (of 0.03 / m at most)."""
    rising = {"rise": np.full((N, N, N), 5.0)}
    thin, thick = (painted(smoke=amount * moment()["smoke"] / 3e-6, **rising)[0] for amount in (6e-7, 6e-6))
    thin, thick = (np.percentile(each[each > 1e-3], 75.0) / 0.03 for each in (thin, thick))
    assert thin < 0.5
    assert thick > 0.6


def test_where_no_smoke_is_none_is_painted():
    density, fresh, glow = painted(smoke=np.zeros((N, N, N)))
    assert not density.any()
    assert not fresh.any()
    assert glow is None
    density = painted()[0]
    assert density[24, 24, 19] > 0.0
    assert not density[:3].any()


def test_share_scales_and_nothing_is_thicker_than_the_limit():
    whole, half = painted()[0], painted(share=0.5)[0]
    assert np.allclose(half, 0.5 * whole)
    assert painted(smoke=np.full((N, N, N), 1e-3))[0].max() <= 0.03 * (1 + 1e-6)


def test_smoke_stands_on_the_true_ground_and_is_thin_at_its_roots():
    dense = np.full((N, N, N), 1e-6)
    density = painted(smoke=dense, surface=200.0, weights=(0.0, 1e-3))[0][24, 24]
    assert not density[: int(200 / VOXEL) - 1].any()
    low, high = density[int(200 / VOXEL) + 1], density[int(200 / VOXEL) + 10]
    assert 0.0 < low < 0.5 * high


def test_young_smoke_is_fresh():
    assert painted(age=np.full((N, N, N), 10.0))[1].max() == pytest.approx(1.0)
    assert painted()[1].max() == 0.0


@pytest.mark.parametrize(
    "name", ["age", "rise", "temperature_excess", "heights", "drift", "ground", "levels"]
)
def test_arrays_of_other_shapes_are_refused(name):
    with pytest.raises(ValueError, match=name):
        flow.Detail(**moment(**{name: np.zeros((3, 3, 3))}))


def test_bad_calls():
    detail = flow.Detail(**moment())
    with pytest.raises(ValueError, match="share"):
        detail.paint((0, 0, 0), 25.0, np.zeros((4, 4)), np.zeros((4, 5)), 8)
    with pytest.raises(ValueError, match="wanted"):
        detail.paint((0, 0, 0), 25.0, np.zeros((4, 4)), np.zeros((4, 4)), 8, np.ones((2, 1, 1), bool))
    with pytest.raises(ValueError, match="period"):
        in_wind(period=0.0)
