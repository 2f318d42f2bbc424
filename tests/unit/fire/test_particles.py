"""Exact steps of one particle: against 50-digit closed forms, any step, any relaxation, the ground."""

import firetwin_core as core
import mpmath
import numpy as np
import pytest
from firetwin_core import constants, particles
from firetwin_core.geo import HeightField
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

speeds = st.tuples(*[st.floats(-50, 50)] * 3)


def closed_form(x, v, wind, gust, bend, lift, tau, t):
    """The solution of dv/dt = (wind + gust t + bend t^2 / 2 - v) / tau + lift, with 50 digits.

    v = A + B t + C t^2 + (v0 - A) e^(-t / tau); comparing powers of t gives C, B and A.
    """
    with mpmath.workdps(50):
        x, v, u, w, q, a, tau, t = (
            mpmath.mpf(float(value)) for value in (x, v, wind, gust, bend, lift, tau, t)
        )
        third = q / 2
        second = w - 2 * tau * third
        first = u + tau * a - tau * second
        decay = mpmath.exp(-t / tau)
        velocity = first + second * t + third * t**2 + (v - first) * decay
        place = x + first * t + second * t**2 / 2 + third * t**3 / 3 + (v - first) * tau * (1 - decay)
        return float(place), float(velocity)


def one(x, v, wind, step, tau, lift, **options):
    position, velocity, landed = particles.advance([x], [v], wind, step, tau, lift, **options)
    return position[0], velocity[0], landed[0]


@settings(deadline=None, max_examples=examples(200))
@given(speeds, speeds, speeds, speeds, st.floats(-30, 30), st.floats(-4, 4), st.floats(-6, 3))
@example((1.0, 2.0, 3.0), (9.0, 0.0, 0.0), (9.0, 0.0, 0.0), (9.0, 0.0, 0.0), -9.8, 0.0, 0.0)
def test_one_step_is_the_closed_form(velocity, wind, middle, end, lift, log_tau, log_step):
    tau, step = 10.0**log_tau, 10.0**log_step
    place, speed, _ = one((0, 0, 0), velocity, wind, step, tau, lift, wind_middle=middle, wind_end=end)
    scale = 1 + max(np.abs([velocity, wind, middle, end]).max(), abs(lift) * min(tau, step))
    u, m, e = np.array([wind, middle, end])
    gust, bend = (4 * m - 3 * u - e) / step, 4 * (u - 2 * m + e) / step**2
    for i, a in enumerate((0, 0, lift)):
        x, v = closed_form(0, velocity[i], u[i], gust[i], bend[i], a, tau, step)
        assert speed[i] == pytest.approx(v, rel=0, abs=3e-14 * scale)
        assert place[i] == pytest.approx(x, rel=0, abs=3e-14 * scale * step)


def test_limits_of_the_relaxation():
    place, speed, _ = one((0, 0, 10), (3, 0, 4), (5, 6, 7), 2.0, np.inf, -9.0)
    np.testing.assert_allclose((place, speed), ([6, 0, 10 + 8 - 18], [3, 0, 4 - 18]))
    place, speed, _ = one((0, 0, 10), (3, 0, 4), (5, 6, 7), 2.0, 0.0, -9.0)
    np.testing.assert_allclose((place, speed), ([10, 12, 24], [5, 6, 7]))


def test_terminal_speed_and_stability():
    """A step of a thousand relaxations ends at wind + lift tau; explicit Euler would explode."""
    _, speed, _ = one((0, 0, 0), (100, 100, 100), (5, 0, 1), 300.0, 0.3, -9.8)
    np.testing.assert_allclose(speed, [5, 0, 1 - 0.3 * 9.8], atol=1e-12)


@settings(deadline=None)
@given(speeds, speeds, st.floats(0.01, 10), st.integers(1, 200))
def test_in_constant_wind_the_step_does_not_matter(velocity, wind, tau, steps):
    far = particles.advance([[0, 0, 0]], [velocity], wind, 10.0, tau)
    state = [[0, 0, 0]], [velocity]
    for _ in range(steps):
        state = particles.advance(*state, wind, 10.0 / steps, tau)[:2]
    np.testing.assert_allclose(state[0], far[0], atol=1e-9)
    np.testing.assert_allclose(state[1], far[1], atol=1e-10)


def gust(t):
    """A wind whose exact path is known: each component of u is u0 + A sin(w t)."""
    return np.array([8 + 3 * np.sin(1.3 * t), -2 + 2 * np.sin(0.7 * t), 1.5 * np.sin(0.9 * t)])


def reference_in_gusts(velocity, tau, lift, duration):
    """Runge-Kutta 4 with steps of 2 ms: its error is far below the error of both methods compared."""

    def rate(t, v):
        return (gust(t) - v) / tau + np.array([0, 0, lift])

    step = 2e-3
    x, v = np.zeros(3), np.array(velocity, float)
    for i in range(round(duration / step)):
        t = i * step
        k1 = rate(t, v)
        k2 = rate(t + step / 2, v + step / 2 * k1)
        k3 = rate(t + step / 2, v + step / 2 * k2)
        k4 = rate(t + step, v + step * k3)
        x = x + step * (v + step / 6 * (k1 + k2 + k3))
        v = v + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return x


def euler(velocity, tau, lift, duration, rate):
    """Explicit Euler, as fast as NumPy allows: v by a linear recurrence, x by a sum."""
    from scipy.signal import lfilter

    step = 1 / rate
    n = round(duration * rate)
    force = step * (gust(np.arange(n) * step) / tau + np.array([[0], [0], [lift]]))
    v, _ = lfilter([1], [1, -(1 - step / tau)], force, zi=(1 - step / tau) * np.array(velocity)[:, None])
    return step * (np.array(velocity, float) + v[:, :-1].sum(axis=1))


@pytest.mark.parametrize(("tau", "lift"), [(0.3, -9.8), (0.1, -9.8), (0.25, 29.4)])
def test_60_steps_a_second_beat_euler_at_24000(tau, lift):
    velocity, duration = [4.0, -3.0, 15.0], 2.0
    truth = reference_in_gusts(velocity, tau, lift, duration)
    state = [[0, 0, 0]], [velocity]
    for i in range(120):
        state = particles.advance(
            *state,
            gust(i / 60),
            1 / 60,
            tau,
            lift,
            wind_middle=gust((i + 0.5) / 60),
            wind_end=gust((i + 1) / 60),
        )[:2]
    ours = np.linalg.norm(state[0][0] - truth)
    theirs = np.linalg.norm(euler(velocity, tau, lift, duration, 24_000) - truth)
    assert ours <= theirs
    assert theirs < 1e-2


def hills(rng):
    x, y = np.linspace(-500, 500, 41), np.linspace(-400, 400, 33)
    return HeightField(x, y, rng.uniform(0, 60, (33, 41)))


def test_height_field_is_bilinear_in_any_direction():
    x, y = np.array([0.0, 10.0, 30.0]), np.array([-5.0, 5.0])
    h = np.array([[1.0, 2.0, 4.0], [3.0, 5.0, np.nan]])
    for field in (HeightField(x, y, h), HeightField(x[::-1], y[::-1], h[::-1, ::-1])):
        np.testing.assert_allclose(field.at([[0, -5], [5, 0], [20, -5], [-9, -9]]), [1, 2.75, 3, 1])
        assert np.isnan(field.at([[30, 5]]))[0]


@pytest.mark.parametrize("bad", [([0.0], [0, 1]), ([0, 0], [0, 1]), ([0, np.nan], [0, 1])])
def test_impossible_axes(bad):
    with pytest.raises(ValueError, match="x must"):
        HeightField(*bad, np.zeros((2, len(bad[0]))))


@pytest.mark.parametrize("step", [0.02, 0.5, 20.0])
def test_never_below_the_ground(step):
    rng = np.random.default_rng(3)
    ground = hills(rng)
    position = np.column_stack([rng.uniform(-600, 600, (500, 2)), rng.uniform(-10, 200, 500)])
    velocity = rng.normal(0, 20, (500, 3))
    landed = np.zeros(500, bool)
    for _ in range(min(round(20 / step), 100)):
        before = position, landed
        position, velocity, landed = particles.advance(
            position, velocity, (9, 4, 0), step, 0.4, landed=landed, ground=ground
        )
        gap = position[:, 2] - ground.at(position[:, :2])
        assert gap.min() >= -1e-12
        assert np.abs(gap[landed]).max(initial=0) <= 1e-12
        assert (velocity[landed] == 0).all()
        np.testing.assert_array_equal(position[before[1]], before[0][before[1]])
    assert landed.any()


def test_landing_on_a_plane_is_where_the_closed_form_says():
    ground = HeightField([-1e4, 1e4], [-1e4, 1e4], [[-1e3, 1e3], [-1e3, 1e3]])  # z = x / 10
    place, _, landed = one((0, 0, 100), (0, 0, 0), (10, 0, 0), 60.0, 0.0, 0.0, ground=ground)
    assert not landed
    np.testing.assert_allclose(place, [600, 0, 100])
    place, _, landed = one((0, 0, 100), (0, 0, 0), (10, 0, 0), 600.0, 0.0, 0.0, ground=ground)
    assert landed
    np.testing.assert_allclose(place, [1000, 0, 100], atol=1e-9)


def test_no_ground_no_landing():
    ground = HeightField([0, 1], [0, 1], np.full((2, 2), np.nan))
    assert not one((0, 0, 0), (0, 0, 0), (0, 0, 0), 9.0, 1.0, -9.8, ground=ground)[2]


def test_threads_do_not_matter(all_threads):
    rng = np.random.default_rng(4)
    ground, position = hills(rng), rng.uniform(0, 100, (5000, 3))
    results = []
    for threads in (1, 2, 4):
        core.set_threads(threads)
        results.append(particles.advance(position, position, (1, 2, 3), 5.0, 0.5, ground=ground))
    for other in results[1:]:
        for a, b in zip(results[0], other, strict=True):
            np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"step": -1.0}, "step"),
        ({"step": np.nan}, "step"),
        ({"relaxation": -1.0}, "relaxation"),
        ({"relaxation": np.nan}, "relaxation"),
        ({"wind": np.zeros((2, 3))}, "wind must have or broadcast"),
    ],
)
def test_impossible_steps(options, message):
    arguments = {"wind": (0, 0, 0), "step": 1.0, "relaxation": 1.0} | options
    with pytest.raises(ValueError, match=message):
        particles.advance(np.zeros((5, 3)), np.zeros((5, 3)), **arguments)


def test_lift():
    assert particles.lift(0.3, 1.2) == pytest.approx(3 * constants.GRAVITY)
    assert particles.lift(1.2) == 0
    assert particles.lift(200.0) < -9.7
