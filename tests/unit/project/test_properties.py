"""Properties for any input: invariances, conservation, and independence of the number of threads."""

import firetwin_core as core
import geodesy
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core import lod, volume
from firetwin_core.flux import at_time, emitters
from firetwin_core.geo import LocalFrame
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from hypothesis_profiles import examples
from small_run import NX, NY


def intensity(flux, low, high):
    flux = np.atleast_2d(np.asarray(flux, np.float32))
    return emitters(flux, np.zeros((*flux.shape, 3)), low, high).intensity


@settings(deadline=None)
@given(
    st.lists(st.integers(1, 1000), min_size=1, max_size=20),
    st.integers(-10, 10),
    st.integers(0, 1000),
)
def test_normalisation_is_affine_invariant(values, exponent, offset):
    """In steps that float32 holds exactly: F -> 2^k (F + b) changes no intensity."""
    low, high, factor = 1.0, 1000.0, 2.0**exponent
    moved = [factor * (v + offset) for v in values]
    limits = factor * (low + offset), factor * (high + offset)
    np.testing.assert_allclose(intensity(moved, *limits), intensity(values, low, high), rtol=1e-14)


@settings(deadline=None)
@given(arrays(np.float32, (3, 4), elements=st.floats(width=32)), st.floats(-1e30, 1e30), st.floats(0, 1e30))
def test_intensity_is_within_0_and_1_for_any_bits(flux, low, width):
    result = emitters(flux, np.zeros((3, 4, 3)), low, low + width)
    assert ((result.intensity >= 0) & (result.intensity <= 1)).all()
    assert ((result.scale >= 100) & (result.scale <= 150)).all()
    assert ((result.colour >= 100) & (result.colour <= 500)).all()
    assert result.invalid == np.isnan(flux).sum()
    assert len(result) == (flux > 0).sum()


def geocentric(latitude, longitude, height):
    return geodesy.geocentric(np.radians(latitude), np.radians(longitude), np.asarray(height))


@settings(deadline=None)
@given(
    st.floats(-89, 89),
    st.floats(-180, 180),
    arrays(float, (5, 3), elements=st.floats(-1, 1)),
)
def test_a_frame_changes_no_distance(latitude, longitude, offsets):
    """Distances between points are those between their Earth-centred places (to rounding there, 10 nm)."""
    lat = np.clip(latitude + 0.5 * offsets[:, 0], -90, 90)
    lon, height = longitude + 0.5 * offsets[:, 1], 2000 * (1 + offsets[:, 2])
    enu = LocalFrame(latitude, longitude).forward(lat, lon, height)
    centred = geocentric(lat, lon, height)
    distance = np.linalg.norm(enu[:, None] - enu, axis=-1)
    expected = np.linalg.norm(centred[:, None] - centred, axis=-1)
    np.testing.assert_allclose(distance, expected, rtol=0, atol=10e-9)


@settings(deadline=None)
@given(arrays(float, 20, elements=st.floats(allow_nan=True)), st.floats(0, 1e6))
def test_levels_of_any_number_are_levels(distance, nearer):
    levels = lod.levels(distance)
    assert (levels <= 2).all()
    with np.errstate(invalid="ignore", over="ignore"):
        closer = lod.levels(np.abs(distance) - nearer)
        assert (closer[~np.isnan(distance)] <= lod.levels(np.abs(distance))[~np.isnan(distance)]).all()


@settings(
    deadline=None, max_examples=examples(20), suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(arrays(np.float32, (4, 5, 6), elements=st.floats(0, 100, width=32)), st.floats(0.5, 200))
def test_a_volume_keeps_its_mass(tmp_path, density, voxel):
    frame = volume.write(tmp_path / "mass.vdb", {"density": density}, voxel)
    assert frame.mass == pytest.approx(float(density.sum(dtype=np.float64)) * voxel**3, rel=1e-6, abs=1e-12)


def test_the_same_on_any_number_of_threads(make_run, tmp_path, all_threads):
    rng = np.random.default_rng(11)
    flux = np.where(rng.random((200, NY, NX)) < 0.3, rng.lognormal(5, 3, (200, NY, NX)), 0)
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    folder = make_run(heat_flux=flux.astype(np.float32), **none)
    latitude, longitude = np.linspace(38.6, 39.2, 333), np.linspace(-121, -120, 257)
    height = rng.uniform(0, 3000, (333, 257))
    position = rng.uniform(-1e4, 1e4, (5000, 3))

    def results():
        run = runs.open(folder)
        frame = LocalFrame(38.9, -120.5)
        grid = frame.forward_grid(latitude, longitude, height)
        return [
            np.array(run.flux_range()),
            run.arrival_time(),
            at_time(run, 1234.5),
            grid,
            frame.forward(grid[:, 0, 0] * 1e-5 + 38, grid[:, 0, 1] * 1e-5 - 120, height[:, 0]),
            lod.select_nearest(position, position[:7], 1000),
        ]

    core.set_threads(1)
    expected = results()
    for threads in (2, 4, 16):
        core.set_threads(threads)
        for alone, shared in zip(expected, results(), strict=True):
            np.testing.assert_array_equal(alone, shared)
