"""Sensor effects: noise of the stated variance that depends on the key alone, blur, saturation, JPEG."""

import hashlib
import io
from dataclasses import replace

import numpy as np
import plain_samples
import pytest
from firetwin.dataset import distributions, sensor
from firetwin.dataset.sensor import SensorSettings
from hypothesis import given, settings
from hypothesis import strategies as st

KEYS = {"noise": 11, "thermal noise": 12}


def grey(value, kelvin=300.0):
    base = plain_samples.plane(plain_samples.looking(-30.0, size=(320, 240)))
    return replace(
        base,
        rgb=np.full((240, 320, 3), value, np.float32),
        kelvin=np.full((240, 320), kelvin, np.float32),
    )


def test_without_effects_pictures_are_unchanged():
    random = np.random.default_rng(1)
    sample = replace(grey(0.5), rgb=random.integers(0, 256, (240, 320, 3)).astype(np.float32) / 255)
    sensed = sensor.apply(sample, SensorSettings(), KEYS)
    assert np.array_equal(sensed.picture, np.rint(sample.rgb * 255))
    assert np.abs(sensed.kelvin - 300.0).max() < 1e-3


@pytest.mark.parametrize("level", [0.2, 0.5])
def test_noise_has_the_variance_of_the_model(level):
    made = SensorSettings(full_well=2000.0, read_noise=0.01)
    display = float(sensor.to_display(np.array(level)))
    noisy = sensor._measure(grey(display).rgb, made, 3)
    light = sensor.to_linear(noisy)
    expected = np.sqrt(level / 2000.0 + 0.01**2)
    assert light.mean() == pytest.approx(level, abs=5 * expected / np.sqrt(light.size))
    assert light.std() == pytest.approx(expected, rel=0.01)


def test_an_exposure_that_rises_in_the_dark_has_more_noise():
    values = {name: value.default.quantile(0.5) for name, value in distributions.VALUES.items()}
    day, night = SensorSettings.of(values), SensorSettings.of(values, risen=4.0)
    assert night.full_well == pytest.approx(day.full_well / 2.0**1.2)
    assert night.read_noise == pytest.approx(2.0**1.2 * day.read_noise)
    assert night.visible()["exposure_risen_stops"] == 4.0


def test_noise_depends_on_the_key_alone():
    made = SensorSettings(blur=0.5, full_well=5000.0, read_noise=0.002, netd=0.05)
    first, again = (sensor.apply(grey(0.5), made, KEYS) for _ in range(2))
    other = sensor.apply(grey(0.5), made, {"noise": 12, "thermal noise": 12})
    assert first.jpeg == again.jpeg
    assert np.array_equal(first.kelvin, again.kelvin)
    assert not np.array_equal(first.picture, other.picture)
    assert np.array_equal(first.kelvin, other.kelvin)


def test_bits_of_the_noise_are_pinned():
    """Noise of published data sets stays: a new NumPy must not change it."""
    digest = hashlib.sha256(np.round(sensor.gaussian(2**62 + 5, (101,)), 9).tobytes()).hexdigest()
    assert digest[:16] == "c45d93190455d7f2"


def test_normal_numbers_are_normal_and_independent():
    found = sensor.gaussian(7, (200_000,))
    assert found.mean() == pytest.approx(0.0, abs=0.01)
    assert found.var() == pytest.approx(1.0, abs=0.02)
    assert np.mean(found**4) == pytest.approx(3.0, abs=0.1)
    assert abs(np.corrcoef(found[:-1], found[1:])[0, 1]) < 0.01
    assert sensor.gaussian(7, (3,)).shape == (3,)


@given(st.floats(0.3, 3.0))
@settings(max_examples=10)
def test_a_blurred_point_is_the_gaussian_and_keeps_its_light(deviation):
    point = np.zeros((41, 41, 1))
    point[20, 20] = 1.0
    found = sensor.blurred(point, deviation)[..., 0]
    assert found.sum() == pytest.approx(1.0)
    steps = np.arange(41) - 20
    across = np.exp(-0.5 * (steps / deviation) ** 2)
    expected = np.outer(across, across) / across.sum() ** 2
    assert np.abs(found - expected).max() < 2e-4


def test_blur_keeps_a_level_picture_at_its_edges():
    assert np.abs(sensor.blurred(np.full((9, 7, 3), 0.3), 2.0) - 0.3).max() < 1e-12


def test_display_values_return_from_linear_light():
    values = np.linspace(0.0, 1.0, 1001)
    assert np.abs(sensor.to_display(sensor.to_linear(values)) - values).max() < 1e-6
    assert sensor.to_linear(np.array(0.5)) == pytest.approx(0.21404, abs=1e-5)  # IEC 61966-2-1


def test_thermal_noise_and_saturation_are_as_stated():
    made = SensorSettings(netd=0.05, saturation=423.15)
    found = sensor.apply(grey(0.5), made, KEYS).kelvin
    assert found.std() == pytest.approx(0.05, rel=0.02)
    hot = sensor.apply(grey(0.5, kelvin=900.0), made, KEYS).kelvin
    assert hot == pytest.approx(423.15, abs=0.01)


def test_a_jpeg_has_the_quality_that_was_drawn():
    from PIL import Image

    random = np.random.default_rng(2)
    sample = replace(grey(0.5), rgb=random.random((240, 320, 3), np.float32))
    sizes = []
    for quality in (60, 95):
        data = sensor.apply(sample, SensorSettings(jpeg_quality=quality), KEYS).jpeg
        with Image.open(io.BytesIO(data)) as image:
            assert image.size == (320, 240)
        sizes.append(len(data))
    assert sizes[0] < 0.7 * sizes[1]


def test_drawn_values_have_their_units():
    values = {name: value.default.quantile(0.5) for name, value in distributions.VALUES.items()}
    made = SensorSettings.of(values | {"netd": 50.0, "saturation": 150.0})
    assert made.netd == pytest.approx(0.05)
    assert made.saturation == pytest.approx(423.15)
    assert made.jpeg_quality == round(values["jpeg_quality"])
    assert made.thermal()["saturation_c"] == pytest.approx(150.0)
    assert made.visible()["full_well_electrons"] == values["full_well"]
    assert SensorSettings().visible()["full_well_electrons"] is None


def test_the_palette_spans_most_temperatures():
    base = grey(0.5)
    sample = replace(base, kelvin=np.linspace(280.0, 320.0, 240 * 320, dtype=np.float32).reshape(240, 320))
    sensed = sensor.apply(sample, SensorSettings(), KEYS)
    grey_values = sensed.palette[..., 0].ravel()
    assert grey_values[0] == 0
    assert grey_values[-1] == 255
    assert (np.diff(grey_values.astype(int)) >= 0).all()
    assert sensor.apply(base, SensorSettings(), KEYS).conditions["palette"]["high_c"] == pytest.approx(
        31.85, abs=0.01
    )
