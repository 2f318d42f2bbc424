"""Eddies displace the smoke of a flow: no ball stays round, none is lost, and they travel with the air."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.smoke import eddies
from firetwin.smoke.domains import Box, Domain
from firetwin.smoke.snapshots import Snapshot

N, CELL = 40, 200.0
DOMAIN = Domain(
    Box(tuple(CELL * np.arange(N + 1.0)), (N, N), CELL, (0.0, 0.0)),
    np.zeros((N, N)),
    0.0,
    CELL * N,
    Path("none"),
    Scale(CELL),
)


def ball(middle=(24.0, 20.0, 20.0), drift=(0.0, 0.0, 0.0), weights=(1.0, 0.0)):
    """A round thermal of smoke, in air that has moved by `drift` m."""
    away = np.sqrt(sum((np.indices((N, N, N))[axis] - middle[axis]) ** 2 for axis in range(3)))
    smoke = (1.0e-6 / (1.0 + np.exp(2.0 * (away - 7.0)))).astype(np.float32)
    fields = {name: smoke * 1e6 for name in ("age", "rise", "temperature_excess")}
    moved = np.broadcast_to(np.array(drift, np.float32), (N, N, N, 2, 3))
    return Snapshot((0, 0), fields | {"smoke": smoke, "drift": moved}, weights, (3, 4), {}, {})


def off_round(smoke):
    """Area by which smoke from above differs from a disc of the same area and centre, over that area."""
    plane = smoke.sum(axis=0)
    seen = plane > 0.3 * plane.max()
    j, i = np.indices(seen.shape)
    away = np.hypot(j - j[seen].mean(), i - i[seen].mean())
    return float((seen != (away <= np.sqrt(seen.sum() / np.pi))).sum() / seen.sum())


def test_no_ball_stays_round():
    still = ball()
    moved = eddies.displace(still, DOMAIN, 0)
    assert off_round(still.fields["smoke"]) < 0.05
    assert off_round(moved.fields["smoke"]) > 0.1


def test_smoke_is_neither_lost_nor_made():
    still, moved = ball(), eddies.displace(ball(), DOMAIN, 0)
    assert moved.fields["smoke"].sum() == pytest.approx(still.fields["smoke"].sum(), rel=0.03)
    assert moved.fields["smoke"].max() <= still.fields["smoke"].max()


def test_waves_do_not_compress_the_air():
    places = np.random.default_rng(1).uniform(0.0, 30.0, (3, 400)).astype(np.float32)
    step = 0.05
    slopes = []
    for axis in range(3):
        shift = np.zeros((3, 1), np.float32)
        shift[axis] = step
        change = eddies.waves(places + shift, (0, 0, 0)) - eddies.waves(places - shift, (0, 0, 0))
        slopes.append(change / (2.0 * step))
    divergence = sum(slopes[axis][axis] for axis in range(3))
    assert np.abs(divergence).max() < 0.01 * np.abs(slopes).max()


def test_eddies_travel_with_the_air():
    first = eddies.displace(ball(), DOMAIN, 0).fields["smoke"]
    later = eddies.displace(ball((24.0, 20.0, 23.0), (3.0 * CELL, 0.0, 0.0)), DOMAIN, 0).fields["smoke"]
    assert later[:, :, 3:] == pytest.approx(first[:, :, :-3], abs=1e-9)
    fixed = eddies.displace(ball((24.0, 20.0, 23.0)), DOMAIN, 0).fields["smoke"]
    assert np.abs(fixed[:, :, 3:] - first[:, :, :-3]).max() > 1e-7


def test_smoke_at_the_ground_stays_at_its_flames():
    still = ball((0.0, 20.0, 20.0))
    moved = eddies.displace(still, DOMAIN, 0)
    change = np.abs(moved.fields["smoke"] - still.fields["smoke"]).mean(axis=(1, 2))
    assert change[0] < 0.3 * change[6]


def test_clear_air_has_no_eddies():
    still = ball()
    still.fields["smoke"][:] = 0.0
    moved = eddies.displace(still, DOMAIN, 0)
    assert all(np.array_equal(moved.fields[name], still.fields[name]) for name in still.fields)
