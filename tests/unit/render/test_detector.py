"""The detector: blur against SciPy, noise by its statistics, saturation and counts."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core.sensor import PlanckTable
from scipy.ndimage import gaussian_filter

TABLE = PlanckTable((8.0, 14.0))


def flat(kelvin=300.0, shape=(200, 300)):
    return np.full(shape, TABLE.radiance(kelvin), np.float32)


def test_an_ideal_detector_changes_nothing():
    scene = flat() * np.random.default_rng(0).uniform(0.5, 30, (200, 300)).astype(np.float32)
    measured, counts = TABLE.detect(scene, key=3)
    assert np.array_equal(measured, scene)
    assert counts is None


@pytest.mark.parametrize("sigma", [0.5, 1.7])
def test_blur_is_gaussian_and_keeps_radiance(sigma):
    scene = flat(shape=(41, 60))
    scene[20, 25:28] = TABLE.radiance(1200.0)
    measured, _ = TABLE.detect(scene, blur=sigma)
    expected = gaussian_filter(
        scene.astype(np.float64), sigma, mode="nearest", radius=int(np.ceil(4 * sigma))
    )
    np.testing.assert_allclose(measured, expected, rtol=1e-5)
    assert measured.sum() == pytest.approx(scene.sum(), rel=1e-6)


def test_noise_is_that_of_its_netd():
    measured, _ = TABLE.detect(flat(), noise=0.05, key=7)
    kelvin = TABLE.brightness_temperature(measured).astype(np.float64)
    assert kelvin.std() == pytest.approx(0.05, rel=0.02)
    assert kelvin.mean() == pytest.approx(300.0, abs=1e-3)
    rows = (kelvin[1:] - 300.0) * (kelvin[:-1] - 300.0)
    assert abs(rows.mean()) < 0.02 * 0.05**2


def test_noise_is_the_same_for_a_key_and_any_number_of_threads():
    first, _ = TABLE.detect(flat(), noise=0.05, key=7)
    core.set_threads(1)
    try:
        assert np.array_equal(TABLE.detect(flat(), noise=0.05, key=7)[0], first)
    finally:
        core.set_threads(0)
    assert not np.array_equal(TABLE.detect(flat(), noise=0.05, key=8)[0], first)


@pytest.mark.parametrize("bits", [8, 14, 16])
def test_counts_are_proportional_to_radiance_up_to_saturation(bits):
    kelvin = np.linspace(250.0, 900.0, 600, dtype=np.float32).reshape(20, 30)
    scene = TABLE.radiance(kelvin)
    measured, counts = TABLE.detect(scene, saturation=800.0, bits=bits)
    full, most = 2**bits - 1, TABLE.radiance(800.0)
    assert counts.dtype == np.uint16
    assert counts.max() == full
    assert np.all(counts[kelvin > 800.0] == full)
    assert np.abs(counts / full * most - np.minimum(scene, most)).max() <= 0.5 * most / full * 1.0001
    np.testing.assert_allclose(measured, counts / full * most, rtol=1e-6)
    assert TABLE.brightness_temperature(measured).max() == pytest.approx(800.0, abs=1e-3)


@pytest.mark.parametrize(
    "wrong",
    [{"blur": -1}, {"noise": np.nan}, {"saturation": np.inf}, {"bits": 17, "saturation": 800}, {"bits": 8}],
)
def test_impossible_detectors(wrong):
    with pytest.raises(ValueError, match=r"blur|bits|saturation"):
        TABLE.detect(flat(), **wrong)
