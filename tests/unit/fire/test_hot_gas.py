"""Hot gas of a fire in the infrared: it is warmer than the air, and only where smoke is."""

import numpy as np
import pytest
from firetwin.shot.fire import air_temperature
from firetwin_core import volume

AIR = {
    "kelvin": np.full((3, 3), 300.0),
    "elevation": np.zeros((3, 3)),
    "corner": (-500.0, -500.0),
    "spacing": (500.0, 500.0),
    "lapse": 0.0,
    "radiance": np.arange(0.0, 400.0),
    "coldest": 200.0,
    "kelvin_step": 1.0,
    "absorption": 0.01,
}
RAY = ([-100.0, 95.0, 95.0], [[1.0, 0.0, 0.0]], [1e9])


def smoke(thickness=0.01):
    fields = (np.full((40, 20, 20), value, np.float32) for value in (thickness, 0.0, 0.0, 0.0))
    return volume.Bricks(*fields, glow=None, voxel_size=10.0, origin=(0.0, 0.0, 0.0))


def gas(excess, first=(-1000.0, -1000.0)):
    heights = np.broadcast_to(np.array([20.0, 120.0, 300.0])[:, None, None], (3, 12, 12))
    return volume.HotGas(np.full((3, 12, 12), excess), heights, first, 200.0)


def seen(layers, *hot, absorption=8e-6):
    return volume.march_infrared(layers, *RAY, **AIR, hot=hot, gas=absorption)[0]


def test_hot_gas_is_seen_as_a_body_of_its_temperature():
    light, through = seen([smoke()], gas(50.0))
    assert through == pytest.approx(np.exp(-(0.01 * 0.01 + 8e-6 * 50.0) * 390.0), rel=1e-3)
    assert light == pytest.approx((100.0 + 50.0) * (1.0 - through), rel=1e-3)


def test_gas_without_smoke_is_not_seen_and_no_gas_changes_nothing():
    assert seen([smoke(0.0)], gas(50.0)) == pytest.approx([0.0, 1.0])
    assert np.array_equal(seen([smoke()]), seen([smoke()], gas(0.0)))


def test_the_finer_gas_counts_where_it_is():
    elsewhere = gas(20.0, first=(9000.0, 9000.0))
    assert np.array_equal(seen([smoke()], gas(50.0), elsewhere), seen([smoke()], gas(50.0)))
    assert np.array_equal(seen([smoke()], gas(50.0), gas(20.0)), seen([smoke()], gas(20.0)))


def test_cells_of_other_shapes_are_refused():
    with pytest.raises(ValueError, match="two cells"):
        seen([smoke()], volume.HotGas(np.ones((1, 4, 4)), np.ones((1, 4, 4)), (0.0, 0.0), 10.0))


def test_smoke_far_above_has_the_temperature_of_the_tropopause():
    """18 km above the ground it had 185 K."""
    coldest = air_temperature.TROPOPAUSE
    aloft = {"elevation": np.full((3, 3), -18e3), "lapse": air_temperature.LAPSE, "coldest": coldest}
    table = np.arange(100.0, 500.0)  # at `coldest`: 100
    light, through = volume.march_infrared(
        [smoke()], *RAY, **AIR | aloft | {"radiance": table}, hot=(), gas=0.0
    )[0]
    assert light == pytest.approx(100.0 * (1.0 - through), rel=1e-6)
    assert 216.0 < coldest < 217.0
