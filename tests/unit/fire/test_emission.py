"""Particles at any time without the times before it."""

import algorithms
import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import particles
from firetwin_core.geo import HeightField
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

EMBER = particles.ParticleKind(particles.lift(200.0), (0.1, 0.6), (5.0, 25.0), (0.0, 4.0), (5.0, 60.0))
PLACES = np.array([[0.0, 0.0, 20.0], [100.0, -50.0, 30.0], [5.0, 5.0, 25.0]])
WIND = np.array([[8.0, 0, 0], [12.0, 5, 0], [3.0, 9, 0]])


def cloud(time, places=PLACES, ground=None, id=(7, 8, 9), seed=1, wind=WIND, **options):
    arguments = {"start": 0.0, "end": 100.0, "rate": 4.0, "kind": EMBER, "wind_time": (0, 30, 90)} | options
    return particles.state(time, places, wind=wind, id=id, size=10.0, ground=ground, seed=seed, **arguments)


@pytest.mark.parametrize(
    ("id", "reason"),
    [
        ((7.0, 8.5, 9.0), "id must contain integers, not float64"),
        ((7, -8, 9), "id contains an integer out of range for uint64"),
    ],
)
def test_sources_are_numbered_in_whole_numbers(id, reason):
    with pytest.raises(ValueError, match=reason):
        cloud(10.0, id=id)


def transcription(id, number, seed):
    """The random numbers of one particle, by the plain Philox."""
    unit = [
        (bits >> 11) * 2.0**-53
        for block in (0, 1)
        for bits in algorithms.philox((id, number, block, 0), (seed, 1))
    ]
    names = ("launch", "life", "relaxation", "rise", "turn", "spread", "east", "north")
    return dict(zip(names, unit, strict=True))


def test_one_particle_by_hand():
    alive = cloud(10.0)
    i = 3
    source, number = int(alive.source[i]), int(alive.number[i])
    u = transcription(7 + source, number, 1)
    launch = (number + u["launch"]) / 4.0
    age = 10.0 - launch
    assert alive.age[i] == pytest.approx(age)
    assert alive.life[i] == pytest.approx(5 + 55 * u["life"])
    turn, spread = 2 * np.pi * u["turn"], 4 * u["spread"]
    velocity = [spread * np.cos(turn), spread * np.sin(turn), 5 + 20 * u["rise"]]
    place = PLACES[source] + 10 * np.array([u["east"] - 0.5, u["north"] - 0.5, 0])
    gust = (WIND[1] - WIND[0]) / 30
    moved = particles.advance(
        [place],
        [velocity],
        WIND[0] + gust * launch,
        age,
        0.1 + 0.5 * u["relaxation"],
        particles.lift(200.0),
        wind_end=WIND[0] + gust * 10.0,
    )
    np.testing.assert_allclose(alive.position[i], moved[0][0], atol=1e-11)
    np.testing.assert_allclose(alive.velocity[i], moved[1][0], atol=1e-11)


def named(found):
    return {
        (s, n): i for i, (s, n) in enumerate(zip(found.source.tolist(), found.number.tolist(), strict=True))
    }


def test_every_particle_that_lives_is_there():
    particles = named(cloud(40.0))
    for source in range(3):
        for number in range(400):
            u = transcription(7 + source, number, 1)
            launch = (number + u["launch"]) / 4.0
            lives = launch <= 40.0 < launch + 5 + 55 * u["life"]
            assert ((source, number) in particles) == lives
    assert len(cloud(-0.1)) == 0
    assert len(cloud(100.0 + 60.0)) == 0
    assert 0 < len(cloud(140.0)) < len(cloud(90.0))


def hills():
    rng = np.random.default_rng(2)
    return HeightField(
        np.arange(-2000, 2001, 50.0), np.arange(-2000, 2001, 50.0), rng.uniform(0, 30, (81, 81))
    )


def test_a_frame_needs_no_frame_before_it():
    """A particle that lies at one time lies at the same place at every later time, in any order."""
    ground = hills()
    landed = {}
    times = np.linspace(0, 150, 61)
    for time in np.random.default_rng(0).permutation(times):
        particles = cloud(time, ground=ground)
        again = cloud(time, ground=ground)
        np.testing.assert_array_equal(particles.position, again.position)
        gap = particles.position[:, 2] - ground.at(particles.position[:, :2])
        assert gap.min(initial=0) >= -1e-9
        for name, i in named(particles).items():
            if particles.landed[i]:
                landed.setdefault(name, []).append((time, *particles.position[i]))
    assert len(landed) > 100
    for seen in landed.values():
        assert len({place[1:] for place in seen}) == 1


def test_landed_ones_never_fly_again():
    ground = hills()
    first = {}
    for time in np.linspace(0, 100, 101):
        found = cloud(time, ground=ground)
        for name, i in named(found).items():
            assert found.landed[i] or name not in first
            if found.landed[i]:
                first.setdefault(name, time)


def test_sources_do_not_touch_each_other():
    together = cloud(33.0)
    alone = cloud(33.0, places=PLACES[1:2], id=(8,))
    np.testing.assert_array_equal(together.position[together.source == 1], alone.position)


def test_steps_of_the_wind_table_do_not_matter():
    """A finer table of the same wind gives the same paths."""
    fine_time = np.linspace(0, 90, 31)
    fine = np.column_stack([np.interp(fine_time, (0, 30, 90), WIND[:, i]) for i in range(3)])
    np.testing.assert_allclose(
        cloud(70.0, wind=fine, wind_time=fine_time).position, cloud(70.0).position, atol=1e-9
    )


def test_wind_of_each_source():
    each = np.repeat(WIND[:, None], 3, axis=1)
    np.testing.assert_array_equal(cloud(50.0, wind=each).position, cloud(50.0).position)
    each[:, 2] = 0
    other = cloud(50.0, wind=each)
    moved = other.source == 2
    assert (np.abs(other.position[moved, :2] - PLACES[2, :2]) < 15).all()
    np.testing.assert_array_equal(other.position[~moved], cloud(50.0).position[~moved])


@settings(deadline=None, max_examples=examples(25))
@given(st.floats(0, 160), st.integers(0, 2**64 - 1))
def test_threads_do_not_matter(time, seed):
    core.set_threads(1)
    one = cloud(time, seed=seed)
    core.set_threads(0)
    np.testing.assert_array_equal(one.position, cloud(time, seed=seed).position)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rate": -1.0}, "rate"),
        ({"rate": np.nan}, "rate"),
        ({"rate": 1e9}, "limit"),
        ({"wind_time": (0, 0, 1)}, "ascend"),
        ({"kind": particles.ParticleKind(-9, (0.5, 0.1), (0, 1), (0, 1), (1, 2))}, "relaxation"),
        ({"kind": particles.ParticleKind(-9, (0.1, 0.2), (0, 1), (0, 1), (1, np.inf))}, "life"),
    ],
)
def test_impossible_emissions(options, message):
    with pytest.raises(ValueError, match=message):
        cloud(1.0, **options)
    with pytest.raises(ValueError, match="finite"):
        cloud(np.nan)
