"""The buoyant flow: conservation, rest, and independence of threads and interruptions."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import flow
from flow_conservation import advected
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

CP, KAPPA, GRAVITY = 1004.7, 287.05 / 1004.7, 9.80665


def box(
    shape=(24, 32),
    spacing=100.0,
    top=2000.0,
    levels=20,
    wind=(0.0, 0.0),
    lapse=0.003,
    *,
    ground=None,
    water=None,
    pressure=101325.0,
    **options,
):
    """A small box with the same wind at all heights and air that warms upwards by `lapse` K/m."""
    profile = flow.Profile([0.0, top], [300.0, 300.0 + lapse * top], [wind, wind], water, pressure)
    domain = flow.Domain(np.linspace(0, top, levels + 1), shape, spacing, ground=ground)
    return flow.Solver(domain, profile, flow.SolverSettings(**options))


def hills(shape, height, seed=3):
    rng = np.random.default_rng(seed)
    y, x = np.indices(shape)
    waves = [
        np.sin(x * a + p) * np.cos(y * b + q) for a, b, p, q in rng.uniform(0.1, 0.6, (4, 4)) * [1, 1, 9, 9]
    ]
    return height * sum(waves)


def plume(solver, power=5e9, at=None):
    """One steady fire near the middle."""
    _, ny, nx = solver.shape
    place = np.add(solver.corner, np.multiply(solver.spacing, at or (nx / 2 + 0.2, ny / 2 - 0.3)))
    solver.set_sources([place, place + solver.spacing], [0.7 * power, 0.3 * power], [8.0, 2.0])
    return solver


def volumes(solver):
    """Volumes of cells over level ground, m3 (level, 1, 1)."""
    return (np.diff(solver.levels) * solver.spacing**2)[:, None, None]


def same(a, b):
    """Return True if two states are identical bit by bit."""
    return a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a)


@pytest.mark.parametrize("water", [None, [0.012, 0.004]])
def test_rest_stays_at_rest_over_hills(water):
    solver = box(ground=hills((24, 32), 60.0), water=water, lapse=0.006)
    before = solver.state()
    solver.step(10.0, 5)
    assert np.ptp(solver.heights()[0]) > 100
    after = solver.state()
    assert all(np.array_equal(before[key], after[key]) for key in ("u", "v", "w", "theta", "smoke"))


def test_a_steady_wind_stays_what_it_is():
    heights, wind = [0.0, 500.0, 2000.0], [[4.0, -1.0], [8.0, 0.0], [12.0, 5.0]]
    domain = flow.Domain(np.linspace(0, 2000, 21), (24, 32), 100.0)
    solver = flow.Solver(domain, flow.Profile(heights, [300.0, 301.0, 310.0], wind))
    before = solver.velocity()
    solver.step(5.0, 20)
    np.testing.assert_allclose(solver.velocity(), before, rtol=0, atol=1e-5)
    assert solver.velocity()[0, 0, 0, 0] == pytest.approx(4.0 + 4.0 * 50 / 500)


def test_the_wind_around_changes():
    solver = box(wind=(5.0, 0.0))
    solver.set_wind([[3.0, 2.0], [3.0, 2.0]])
    solver.step(5.0, 3)
    np.testing.assert_allclose(solver.velocity(), np.broadcast_to([3, 2, 0], (20, 24, 32, 3)), atol=1e-5)


def test_pure_advection_keeps_mass_and_shape():
    """A Gaussian ball of 4 cells' radius carried 20: mass to 1e-6, shape within 8 %, peak within 20 %."""
    mass, shape, solver = advected()
    assert mass < 1e-6
    assert shape < 0.08
    smoke = solver.smoke().astype(float)
    assert smoke.max() == pytest.approx(1e-3 * solver.density[10], rel=0.2)
    carried = smoke > 0.05 * smoke.max()
    np.testing.assert_allclose(solver.age()[carried], 175.0, rtol=1e-4)


def test_mass_adds_up_when_the_plume_leaves():
    solver = plume(box(wind=(12.0, 3.0), gust_strength=0.6))
    solver.step(5.0, 80)
    mass = solver.mass()
    assert mass["emitted"] == pytest.approx(10.0 * 400.0, rel=1e-9)
    assert mass["left"] > 0.3 * mass["emitted"]
    assert mass["airborne"] + mass["left"] == pytest.approx(mass["emitted"], rel=1e-6)
    assert np.sum(solver.smoke() * volumes(solver)) == pytest.approx(mass["airborne"], rel=1e-6)


def test_mass_is_that_of_the_true_air_over_hills():
    ground = hills((24, 32), 80.0)
    solver = plume(box(ground=ground, wind=(6.0, 0.0)))
    solver.step(5.0, 30)
    depth = np.gradient(solver.heights().astype(float), axis=0)
    whole = np.sum(solver.smoke() * depth) * solver.spacing**2
    assert whole == pytest.approx(solver.mass()["airborne"], rel=1e-4)


def test_heat_is_what_was_given():
    solver = plume(box(lapse=0.0, sponge_time=1e9, damping_time=1e9), power=4e9)
    solver.step(5.0, 24)
    heat = solver.heat()
    assert heat["given"] == pytest.approx(4e9 * 120.0, rel=1e-9)
    assert heat["held"] == pytest.approx(heat["warmed"], rel=1e-4)
    assert 0.98 < heat["warmed"] / heat["given"] < 1.02
    exner = 1 - GRAVITY * 0.5 * (solver.levels[1:] + solver.levels[:-1]) / (CP * 300) + (1.01325**KAPPA - 1)
    mass = volumes(solver) * solver.density[:, None, None]
    excess = np.sum(solver.temperature_excess() / exner[:, None, None] * mass) * CP
    assert excess == pytest.approx(heat["warmed"], rel=1e-3)


@settings(deadline=None, max_examples=examples(15))
@given(st.integers(0, 2**32 - 1), st.floats(0.1, 30.0), st.floats(1.0, 20.0), st.booleans())
def test_any_wind_is_balanced_and_makes_no_new_extremes(seed, speed, dt, hilly):
    """Random gusts of any Courant number: no divergence is left, smoke stays between 0 and its largest."""
    rng = np.random.default_rng(seed)
    solver = box(
        (12, 16), levels=8, top=800.0, ground=hills((12, 16), 20.0) if hilly else None, sponge_width=3.0
    )
    state = solver.state()
    for key in "uvw":
        state[key] = rng.normal(0, speed, state[key].shape)
    state["smoke"] = rng.uniform(0, 1e-3, state["smoke"].shape) * (rng.random(state["smoke"].shape) < 0.3)
    largest = state["smoke"].max()
    solver.restore(state)
    solver.step(1e-3)  # balances
    assert solver.divergence < 2e-6 * max(1.0, speed)
    first = solver.mass()
    solver.step(dt)
    state, mass = solver.state(), solver.mass()
    assert state["smoke"].min() >= -1e-9
    assert state["smoke"].max() <= largest * (1 + 1e-4)
    whole = first["airborne"] + mass["entered"] - first["entered"] - mass["left"] + first["left"]
    assert mass["airborne"] == pytest.approx(whole, rel=1e-6)


def test_divergence_under_a_plume():
    solver = plume(box(wind=(5.0, 0.0)))
    solver.step(5.0, 20)
    assert solver.state()["w"].max() > 5.0
    assert solver.divergence < 1e-6


def run(threads, water=None):
    core.set_threads(threads)
    solver = plume(box(wind=(4.0, 1.0), gust_strength=0.5, water=water, ground=hills((24, 32), 40.0)))
    solver.step(8.0, 12)
    nest = plume(solver.nest(flow.Domain(solver.levels, (30, 30), 50.0, (800.0, 500.0))), power=5e9)
    solver.step(8.0)
    nest.step(4.0, 2)
    return solver.state(), nest.state()


@pytest.mark.parametrize("water", [None, [0.012, 0.004]])
def test_any_number_of_threads_gives_the_same(all_threads, water):
    first = run(1, water)
    for threads in (2, 4, 16):
        again = run(threads, water)
        assert same(first[0], again[0])
        assert same(first[1], again[1])


@pytest.mark.parametrize("water", [None, [0.012, 0.004]])
def test_going_on_from_a_state_is_going_on(water):
    def begin():
        return plume(box(wind=(6.0, 2.0), gust_strength=0.5, water=water, ground=hills((24, 32), 40.0)))

    def finer(solver):
        return plume(solver.nest(flow.Domain(np.linspace(0, 1800, 25), (32, 30), 50.0, (800.0, 400.0))))

    one = begin()
    one.step(10.0, 7)
    inner = finer(one)
    one.step(10.0)
    inner.step(10.0 / 3, 3)
    kept, kept_inner = one.state(), inner.state()

    two = begin()
    other = finer(two)
    two.restore(kept)
    other.restore(kept_inner)
    for solver, nest in ((one, inner), (two, other)):
        solver.step(10.0, 1)
        nest.step(10.0 / 3, 3)
        solver.step(7.0)
        nest.step(3.5, 2)
    assert same(one.state(), two.state())
    assert same(inner.state(), other.state())
    assert one.mass() == two.mass()
    assert other.time == pytest.approx(one.time)


def test_restored_smoke_moves_where_none_was():
    """The solver skips rows without smoke; a restored state fills them."""
    used, fresh = (box(wind=(6.0, 2.0)) for _ in range(2))
    used.step(5.0)
    state = used.state()
    state["smoke"][8:12, 10:14, 12:18] = 1e-3
    for solver in (used, fresh):
        solver.restore(state)
        solver.step(5.0, 2)
    assert used.state()["smoke"].max() > 1e-4
    assert same(used.state(), fresh.state())


def test_warm_air_is_driven_up_a_slope():
    rise = 0.2 * 100.0 * np.arange(32.0) * np.ones((24, 1))
    solver = box(ground=rise, lapse=0.0, top=3000.0)
    state = solver.state()
    state["theta"][:2] += 2.0
    solver.restore(state)
    solver.step(5.0, 6)
    drift = solver.velocity()[0, 8:16, 12:20, 0].mean()
    expected = GRAVITY * 2.0 / 300.0 * 0.2 * 30.0
    assert 0.3 * expected < drift < 1.1 * expected


def saturation(kelvin, pressure):
    celsius = kelvin - 273.15
    vapour = 610.94 * np.exp(17.625 * celsius / (celsius + 243.04))
    return 0.622 * vapour / (pressure - 0.378 * vapour)


def test_cloud_water_leaves_the_air_just_saturated():
    solver = box(water=[0.02, 0.02], lapse=0.006, pressure=9e4)
    cloud, state = solver.cloud().astype(float), solver.state()
    exner = (0.9**KAPPA) - GRAVITY * 50.0 / (CP * 300.15)
    pressure = 1e5 * exner ** (1 / KAPPA)
    solver = box(water=[0.03, 0.03], lapse=0.006, pressure=9e4)
    cloud, state = solver.cloud().astype(float), solver.state()
    kelvin = (300.0 + state["theta"][0, 0, 0]) * exner + 2.5e6 / CP * cloud[0, 0, 0]
    assert cloud[0, 0, 0] > 0.001
    assert 0.03 - cloud[0, 0, 0] == pytest.approx(saturation(kelvin, pressure), rel=2e-3)


def test_cloud_water_is_that_of_float64():
    """Any air, by bisection: within 2e-7 kg/kg, and none where the air could hold more."""
    solver = box(water=[0.01, 0.01], lapse=0.006, pressure=9e4)
    rng = np.random.default_rng(5)
    state = solver.state()
    state["theta"] = rng.uniform(-60.0, 60.0, state["theta"].shape)
    state["water"] = rng.choice([0.0, 0.002, 0.02], state["theta"].shape) * rng.random(state["theta"].shape)
    solver.restore(state)
    z = 0.5 * (solver.levels[1:] + solver.levels[:-1])
    theta = 300.0 + 0.006 * z
    exner = (solver.density * 287.05 * theta / 1e5) ** (1 / (1 / KAPPA - 1))
    pressure, exner = (1e5 * exner ** (1 / KAPPA))[:, None, None], exner[:, None, None]
    kelvin = (300.0 + state["theta"].astype(float)) * exner
    water = state["water"].astype(float)
    low, high = np.zeros(water.shape), water.copy()
    for _ in range(50):
        middle = 0.5 * (low + high)
        more = water - middle > saturation(kelvin + 2.5e6 / CP * middle, pressure)
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    assert (low > 1e-3).mean() > 0.05
    np.testing.assert_allclose(solver.cloud(), low, atol=2e-7)


def top_of(solver):
    column = solver.smoke().sum((1, 2)) * np.diff(solver.levels)
    return np.interp(0.9, np.cumsum(column) / column.sum(), solver.levels[1:])


def test_condensation_lifts_the_column():
    tops = []
    for water in (None, [0.0135, 0.0135, 0.002]):
        profile = flow.Profile(
            [0.0, 1500.0, 5000.0], [300.0, 300.0, 316.0], [[2.0, 0.0]] * 3, water=water, pressure=9e4
        )
        solver = flow.Solver(flow.Domain(np.linspace(0, 5000, 41), (30, 30), 200.0), profile)
        plume(solver, 6e9).step(10.0, 90)
        tops.append(top_of(solver))
        cloud = solver.cloud().max()
    assert cloud > 1e-3
    assert tops[1] > tops[0] + 300.0


def nested(water=None):
    outer = plume(box((40, 40), wind=(6.0, 0.0), water=water, lapse=0.001))
    outer.step(10.0, 20)
    inner = plume(outer.nest(flow.Domain(outer.levels, (56, 60), 40.0, (900.0, 900.0))), at=(27.5, 27.5))
    outer.set_sources([[2020.0, 1970.0], [2120.0, 2070.0]], [3.5e9, 1.5e9], [8.0, 2.0])
    inner.set_sources([[2020.0, 1970.0], [2120.0, 2070.0]], [3.5e9, 1.5e9], [8.0, 2.0])
    for _ in range(12):
        outer.step(10.0)
        inner.step(2.5, 4)
    return outer, inner


def test_a_nest_goes_with_the_flow_around():
    outer, inner = nested()
    mass = inner.mass()
    assert inner.time == pytest.approx(outer.time)
    assert mass["emitted"] == pytest.approx(1200.0, rel=1e-6)
    assert mass["initial"] + mass["emitted"] + mass["entered"] == pytest.approx(
        mass["airborne"] + mass["left"], rel=1e-6
    )
    assert inner.divergence < 1e-6
    # The same plume: as much smoke within the nest's box, at a similar height.
    there = outer.smoke()[:, 9:31, 9:33] * volumes(outer)
    assert mass["airborne"] == pytest.approx(there.sum(), rel=0.2)
    z = 0.5 * (outer.levels[1:] + outer.levels[:-1])
    heights = [np.sum(a.sum((1, 2)) * z) / a.sum() for a in (there, inner.smoke() * volumes(inner))]
    assert heights[1] == pytest.approx(heights[0], rel=0.25)
    # No smoke on the windward side, where none comes in.
    assert inner.smoke()[:, :, :8].max() < 1e-3 * inner.smoke().max()


def test_a_nest_at_rest_over_finer_hills_stays_at_rest():
    outer = box(ground=hills((24, 32), 60.0), lapse=0.006)
    finer = flow.Domain(outer.levels, (40, 40), 40.0, (600.0, 500.0), hills((40, 40), 70.0, seed=8))
    inner = outer.nest(finer)
    outer.step(10.0)
    inner.step(5.0, 2)
    assert np.abs(inner.velocity()).max() == 0.0


def test_a_nest_in_a_steady_wind_keeps_it_and_follows_its_change():
    outer = box(wind=(5.0, 2.0))
    inner = outer.nest(flow.Domain(outer.levels, (40, 40), 40.0, (600.0, 500.0)))
    outer.step(10.0)
    inner.step(5.0, 2)
    np.testing.assert_allclose(inner.velocity(), np.broadcast_to([5, 2, 0], (20, 40, 40, 3)), atol=1e-4)
    outer.set_wind([[4.0, 3.0], [4.0, 3.0]])
    outer.step(10.0)
    inner.step(5.0, 2)
    np.testing.assert_allclose(inner.velocity(), np.broadcast_to([4, 3, 0], (20, 40, 40, 3)), atol=1e-4)


def test_gusts_share_out_and_keep_the_sum():
    first, second, third = (box(gust_strength=0.6, gust_size=150.0, seed=seed) for seed in (1, 1, 2))
    x = np.arange(500.0, 2500.0, 50.0)
    for solver in (first, second, third):
        solver.set_sources(np.stack([x, x * 0 + 1200], 1), np.full(len(x), 1e8), np.full(len(x), 1.0))
        solver.step(1.0)
    assert same(first.state(), second.state())
    assert not same(first.state(), third.state())
    smoke = first.smoke()[0, 11:13, 6:24].sum(0)
    assert smoke.max() > 1.5 * smoke.min()
    assert first.heat()["given"] == pytest.approx(1e8 * len(x), rel=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"levels": [0.0, 100.0, 90.0, 200.0, 300.0]}, "levels must be strictly increasing"),
        ({"levels": [10.0, 100.0, 200.0, 300.0, 400.0]}, "the first of them 0"),
        ({"shape": (4, 32)}, "shape"),
        ({"spacing": 0.0}, "spacing"),
        ({"wind": [[1.0, np.nan]] * 2}, "wind"),
        ({"potential_temperature": [20.0, 30.0]}, "kelvin"),
        ({"height": [0.0, 0.0]}, "height must be strictly increasing"),
        ({"water": [0.5, 0.5]}, "water"),
        ({"pressure": -1.0}, "pressure"),
        ({"ground": np.zeros((3, 3))}, "ground"),
        ({"ground": np.full((24, 32), np.inf)}, "ground"),
        ({"ground": hills((24, 32), 900.0)}, "half the height of the domain"),
        ({"sponge_width": 20.0}, "half of the domain"),
        ({"smagorinsky": -1.0}, "smagorinsky"),
        ({"source_depth": 0.0}, "source_depth"),
    ],
)
def test_bad_arguments(change, message):
    good = {
        "levels": np.linspace(0, 2000, 21),
        "shape": (24, 32),
        "spacing": 100.0,
        "height": [0.0, 2000.0],
        "potential_temperature": [300.0, 306.0],
        "wind": [[1.0, 0.0]] * 2,
    }
    made(**good)
    with pytest.raises(ValueError, match=message):
        made(**(good | change))


def made(levels, shape, spacing, height, potential_temperature, wind, **more):
    """A solver of arguments that belong to its domain, its profile or its settings."""
    domain = flow.Domain(levels, shape, spacing, ground=more.pop("ground", None))
    air = {name: more.pop(name) for name in ("water", "pressure") if name in more}
    profile = flow.Profile(height, potential_temperature, wind, **air)
    return flow.Solver(domain, profile, flow.SolverSettings(**more))


def test_settings_say_what_they_hold():
    given = {"sponge_width": 3.0, "sponge_time": 9.0, "damping_share": 0.1, "damping_time": 7.0}
    given |= {"drag_time": 5.0, "smagorinsky": 0.2, "source_depth": 30.0, "gust_strength": 0.4}
    given |= {"gust_size": 55.0, "gust_time": 11.0, "seed": 8}
    held = flow.SolverSettings(**given)
    assert {name: getattr(held, name) for name in given} == given
    with pytest.raises(AttributeError):
        held.seed = 1
    with pytest.raises(TypeError):
        flow.SolverSettings(side_width=3.0)


def test_a_nest_without_settings_has_a_wide_and_quick_sponge_layer():
    def end(settings):
        outer = plume(box(wind=(5.0, 1.0)))
        outer.step(10.0, 3)
        inner = plume(outer.nest(flow.Domain(outer.levels, (40, 40), 40.0, (600.0, 500.0)), settings))
        outer.step(10.0)
        inner.step(5.0, 2)
        return inner.state()

    usual = end(None)
    assert same(usual, end(flow.SolverSettings(sponge_width=10.0, sponge_time=8.0)))
    assert not same(usual, end(flow.SolverSettings()))


def test_bad_calls():
    solver = box()
    with pytest.raises(ValueError, match="dt"):
        solver.step(0.0)
    with pytest.raises(ValueError, match="heat"):
        solver.set_sources([[0.0, 0.0]], [-1.0], [0.0])
    with pytest.raises(ValueError, match="one value for each position"):
        solver.set_sources([[0.0, 0.0]], [1.0, 2.0], [0.0])
    with pytest.raises(ValueError, match="one vector for each height"):
        solver.set_wind([[0.0, 0.0]])
    with pytest.raises(ValueError, match="no field"):
        solver.restore({})
    with pytest.raises(ValueError, match="inside of its outer domain"):
        solver.nest(flow.Domain(solver.levels, (40, 40), 40.0, (0.0, 0.0)))
    inner = solver.nest(flow.Domain(solver.levels, (40, 40), 40.0, (600.0, 500.0)))
    with pytest.raises(ValueError, match="overtake"):
        inner.step(1.0)
    state = solver.state()
    state["u"][:] = np.inf
    solver.restore(state)
    with pytest.raises(core.Error):
        solver.step(5.0)


def test_a_source_outside_is_left_out():
    solver = box()
    solver.set_sources([[-500.0, 1000.0], [1600.0, 9e9], [1600.0, 1200.0]], [1e9] * 3, [1.0] * 3)
    solver.step(2.0)
    assert solver.mass()["emitted"] == pytest.approx(2.0)
