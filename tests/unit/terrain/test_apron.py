"""The invented ground beyond the run's grid."""

import numpy as np
import pytest
from firetwin.shot.terrain import apron, noise

CELL = (74.0, 74.0)


@pytest.fixture(scope="module")
def fields():
    """A forest with bare patches, thinner with height."""
    y, x = np.mgrid[:200, :200] * 74.0
    elevation = 1500.0 + 600.0 * noise.fractal(x, y, 6000.0, 4, 3)
    patches = noise.fractal(x, y, 600.0, 3, 9)
    canopy = np.where(patches > 0.15, 0.0, np.clip(2.5 - elevation / 1000.0, 0.0, None))
    axis = np.arange(200) * 74.0 / 111_000.0
    return apron.TerrainFields(38.0 + axis, -120.0 + axis, elevation, canopy, canopy * 0.5 + 0.02)


def test_as_much_of_the_apron_is_bare_as_of_the_grid_at_that_height(fields):
    extended = apron.extend(fields, CELL, 60_000.0, 1)
    out = np.ones(extended.elevation.shape, bool)
    out[extended.margin : -extended.margin, extended.margin : -extended.margin] = False
    shares = []
    for low, high in np.lib.stride_tricks.sliding_window_view(
        np.quantile(fields.elevation, [0.1, 0.5, 0.9]), 2
    ):
        in_grid = (fields.elevation > low) & (fields.elevation < high)
        there = out & (extended.elevation > low) & (extended.elevation < high)
        assert there.sum() > 1000
        for field, other in (
            (fields.canopy_fuel, extended.canopy_fuel),
            (fields.surface_fuel, extended.surface_fuel),
        ):
            assert other[there].mean() == pytest.approx(field[in_grid].mean(), rel=0.25)
        shares.append(
            (np.mean(extended.canopy_fuel[there] < 0.01), np.mean(fields.canopy_fuel[in_grid] < 0.01))
        )
    for found, wanted in shares:
        assert found == pytest.approx(wanted, abs=0.08)
    assert shares[0][1] > 0.1


def test_nothing_of_the_grid_is_changed_and_the_apron_has_the_grids_fuels(fields):
    extended = apron.extend(fields, CELL, 60_000.0, 1)
    inner = slice(extended.margin, -extended.margin)
    for name in ("elevation", "canopy_fuel", "surface_fuel"):
        np.testing.assert_array_equal(getattr(extended, name)[inner, inner], getattr(fields, name))
        values = getattr(extended, name)
        assert np.isfinite(values).all()
    assert extended.canopy_fuel.min() >= 0.0
    assert extended.canopy_fuel.max() <= fields.canopy_fuel.max()


def test_land_goes_on_across_the_edge_as_it_is_within(fields):
    """No streak: fuels vary equally along the edge and across it. No kink: slopes there are as elsewhere."""
    made = apron.extend(fields, CELL, 60_000.0, 1)
    margin = made.margin
    for turn in range(4):
        canopy, height = (np.rot90(field, turn) for field in (made.canopy_fuel, made.elevation))
        inner = slice(margin, -margin)
        out, within = canopy[margin - 6 : margin, inner], canopy[margin : margin + 6, inner]
        along, away = (np.abs(np.diff(out, axis=axis)).mean() for axis in (1, 0))
        assert away > 0.7 * along
        assert out.mean() == pytest.approx(within.mean(), rel=0.1)
        slope = height[margin, inner] - height[margin + 1, inner]
        beyond = (height[margin - 1, inner] - height[margin, inner]) / apron.GROWTH
        assert np.corrcoef(slope, beyond)[0, 1] > 0.8


def test_ridges_do_not_stand_in_rows_across_the_edge():
    """Heights beyond it bend along it no more than within: fine relief at it is not drawn out."""
    y, x = np.mgrid[:120, :120]
    elevation = 400.0 * np.sin(x / 31) + 60.0 * np.sin(x / 3.1 + y / 4.3) * np.cos(y / 3.7 - x / 5)
    axis, fuel = np.arange(120) * 30.0 / 111_000.0, np.ones(elevation.shape)
    made = apron.extend(
        apron.TerrainFields(38.0 + axis, -120.0 + axis, elevation, fuel, fuel), (30.0, 24.0), 20_000.0, 1
    )
    margin = made.margin
    for turn in range(4):
        height = np.rot90(made.elevation, turn)[:, margin:-margin]
        out, within = height[margin - 20 : margin - 5], height[margin + 5 : margin + 20]
        bends = [np.abs(np.diff(rows, 2, axis=1)).mean() for rows in (out, within)]
        assert bends[0] < 1.2 * bends[1]


def island(shore):
    """A grid whose land ends at a distance (cells) from its middle, or that has none: sea at 0 m."""
    y, x = np.mgrid[-60:60, -60:60]
    land = np.maximum(shore - np.hypot(x, y), 0.0)
    axis = np.arange(120) * 74.0 / 111_000.0
    return apron.TerrainFields(38.0 + axis, -120.0 + axis, 12.0 * land, 0.4 * (land > 0), 0.8 * (land > 0))


def test_the_sea_goes_on_round_an_island():
    made = apron.extend(island(45.0), CELL, 60_000.0, 1)
    out = np.ones(made.elevation.shape, bool)
    out[made.margin : -made.margin, made.margin : -made.margin] = False
    assert not made.elevation[out].any()
    assert not made.surface_fuel[out].any()
    assert not made.canopy_fuel[out].any()


def test_a_coast_goes_on_as_land_and_sea():
    """The west is sea, the east hills."""
    y, x = np.mgrid[-60:60, -60:60]
    land = np.maximum(x + 8.0 * np.sin(y / 9.0), 0.0)
    axis = np.arange(120) * 74.0 / 111_000.0
    height = 10.0 * land * (1.0 + 0.3 * np.sin(y / 4.0))
    fields = apron.TerrainFields(38.0 + axis, -120.0 + axis, height, 0.4 * (land > 0), 0.8 * (land > 0))
    made = apron.extend(fields, CELL, 60_000.0, 1)
    middle = len(made.latitude) // 2
    far = made.margin // 2
    assert made.elevation[middle - 20 : middle + 20, :far].max() == 0.0
    assert (made.surface_fuel[middle - 20 : middle + 20, -far:] > 0.0).mean() > 0.5
    assert made.elevation[middle - 20 : middle + 20, -far:].mean() > 20.0


def test_a_lake_at_the_edge_is_no_sea():
    fields = island(200.0)
    fields.elevation[:20, 50:70] = 50.0
    fields.surface_fuel[:20, 50:70] = fields.canopy_fuel[:20, 50:70] = 0.0
    made = apron.extend(fields, CELL, 60_000.0, 1)
    assert (made.surface_fuel[: made.margin - 3] > 0.0).mean() > 0.5
