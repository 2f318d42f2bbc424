"""Sensor effects of a sample, applied after rendering: degraded and clean pictures share their labels.

Visible camera: a Gaussian blur of the optics in linear light, shot noise of `full_well` electrons at white,
read noise, and JPEG compression. Signal and noise are in linear light of the display (sRGB, IEC 61966-2-1),
each channel is measured in each pixel, and the film's contrast is already in the signal: correlations by
demosaicing and the response of one camera model are not simulated. The exposure rises in the dark:
`_AMPLIFIED` of its stops are amplification, with fewer electrons at white and more read noise, and the others
are a longer exposure. The noise model is additive and Gaussian, variance = signal / full_well + read_noise^2
(the linear model of EMVA Standard 1288, without the quantisation noise, which the 8-bit file has itself).

Thermal camera: `firetwin_core.sensor.PlanckTable.detect`, with NETD at 300 K and saturation. A sample's noise
depends only on the keys of its draw: it is equal on all machines and in any order.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..imaging.srgb import to_display, to_linear
from ..shot.sections.thermal import BANDS
from .files import eight_bits
from .rendered import Rendered

Array = NDArray[np.float32]

_KELVIN = 273.15
_AMPLIFIED = 0.3  # share of the risen stops that are amplification (assumed)
_REACH = 4.0  # standard deviations at which a blur ends
_SHOWN = (1.0, 99.5)  # percentiles that the palette of a thermal picture spans
_LEAST_SPAN = 5.0  # K, least range of the palette
_PALETTE = "white-hot"


@dataclass(frozen=True)
class SensorSettings:
    """Properties of the cameras of a sample.

    Attributes
    ----------
    blur
        Standard deviation of the blur, pixels, of both cameras.
    full_well
        Electrons at white.
    read_noise
        Standard deviation of the read noise, share of white.
    jpeg_quality
        Quality of libjpeg, 1 to 100.
    netd
        Noise-equivalent temperature difference at 300 K, K.
    saturation
        Brightness temperature at which the thermal camera saturates, K; 0: never.
    band
        Thermal band (see `shot.sections.thermal.BANDS`).
    risen
        Stops by which the exposure has risen in the dark.
    """

    blur: float = 0.0
    full_well: float = np.inf
    read_noise: float = 0.0
    jpeg_quality: int = 95
    netd: float = 0.0
    saturation: float = 0.0
    band: str = "lwir"
    risen: float = 0.0

    @classmethod
    def of(cls, values: Mapping[str, float], risen: float = 0.0, band: str = "lwir") -> SensorSettings:
        """Take the drawn values of a sample (see `distributions.VALUES`), for an exposure that has risen."""
        gain = 2.0 ** (_AMPLIFIED * risen)
        return cls(
            blur=values["blur"],
            full_well=values["full_well"] / gain,
            read_noise=values["read_noise"] * gain,
            risen=risen,
            jpeg_quality=round(values["jpeg_quality"]),
            netd=1.0e-3 * values["netd"],
            saturation=values["saturation"] + _KELVIN,
            band=band,
        )

    def visible(self) -> dict[str, Any]:
        """Return the properties of the visible camera for the metadata."""
        return {
            "blur_px": self.blur,
            "full_well_electrons": self.full_well if np.isfinite(self.full_well) else None,
            "read_noise_of_white": self.read_noise,
            "jpeg_quality": self.jpeg_quality,
            "exposure_risen_stops": self.risen,
        }

    def thermal(self) -> dict[str, Any]:
        """Return the properties of the thermal camera for the metadata."""
        return {
            "band_um": list(BANDS[self.band]),
            "netd_mk_at_300_k": 1.0e3 * self.netd,
            "saturation_c": self.saturation - _KELVIN if self.saturation else None,
            "blur_px": self.blur,
        }


@dataclass(frozen=True)
class Sensed:
    """Pictures of a sample with sensor effects.

    Attributes
    ----------
    settings
        Properties of the cameras.
    picture
        (h, w, 3) visible picture before its compression.
    kelvin
        (h, w) measured brightness temperature, K.
    """

    settings: SensorSettings
    picture: NDArray[np.uint8]
    kelvin: Array

    @cached_property
    def jpeg(self) -> bytes:
        """The visible picture as JPEG, with chroma at half resolution."""
        from PIL import Image

        stream = io.BytesIO()
        Image.fromarray(self.picture).save(stream, "JPEG", quality=self.settings.jpeg_quality, subsampling=2)
        return stream.getvalue()

    @cached_property
    def span(self) -> tuple[float, float]:
        """Temperatures at the ends of the palette, K."""
        low, high = np.percentile(self.kelvin, _SHOWN)
        return float(low), float(max(high, low + _LEAST_SPAN))

    @property
    def palette(self) -> NDArray[np.uint8]:
        """The thermal picture (h, w, 3) in the colours of a palette, linear over `span`."""
        return eight_bits(sensor.colour(self.kelvin, *self.span, _PALETTE))

    @property
    def conditions(self) -> dict[str, Any]:
        """Conditions of the measurement of the thermal picture, as JSON represents them."""
        low, high = self.span
        return {
            "quantity": "brightness temperature (emissivity 1)",
            "unit": "degrees C",
            "emissivity": 1.0,
            "path": "air and smoke between surface and camera are in the value; it is not corrected for them",
            "reflected": "not corrected",
            "radiometric_source": "simulation; not a recording of a camera",
            **self.settings.thermal(),
            "palette": {"name": _PALETTE, "low_c": low - _KELVIN, "high_c": high - _KELVIN},
        }


def apply(rendered: Rendered, settings: SensorSettings, key: Mapping[str, int]) -> Sensed:
    """Apply the effects of a sample's sensors.

    Parameters
    ----------
    key
        Seeds of the noise, by name: "noise" of the visible and "thermal noise" of the thermal camera.
    """
    return Sensed(
        settings,
        eight_bits(_measure(rendered.rgb, settings, key["noise"])),
        _measure_heat(rendered.kelvin, settings, key["thermal noise"]),
    )


def _measure(picture: Array, settings: SensorSettings, key: int) -> Array:
    """Blur a display picture (h, w, 3) of 0..1 in linear light, and add shot and read noise."""
    light = blurred(to_linear(np.clip(picture, 0.0, 1.0)), settings.blur)
    variance = light / settings.full_well + settings.read_noise**2
    noisy = light + np.sqrt(variance) * gaussian(key, light.shape) if variance.any() else light
    return to_display(np.clip(noisy, 0.0, 1.0))


def _measure_heat(kelvin: Array, settings: SensorSettings, key: int) -> Array:
    """Measure brightness temperatures (h, w), K, with the thermal detector."""
    table = sensor.PlanckTable(BANDS[settings.band])
    measured, _ = table.detect(
        table.radiance(kelvin),
        blur=settings.blur,
        noise=settings.netd,
        saturation=settings.saturation,
        key=key & 0xFFFFFFFF,
    )
    return np.asarray(table.brightness_temperature(measured), np.float32)


def blurred(picture: NDArray, deviation: float) -> NDArray:
    """Blur a picture (h, w, c) by a Gaussian of a standard deviation in pixels; edges are replicated."""
    if deviation <= 0.0:
        return picture
    reach = int(np.ceil(_REACH * deviation))
    weight = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    weight /= weight.sum()
    for axis in (0, 1):
        pads = [(reach, reach) if k == axis else (0, 0) for k in range(picture.ndim)]
        padded, size = np.pad(picture, pads, "edge"), picture.shape[axis]
        picture = sum(each * np.take(padded, range(k, k + size), axis=axis) for k, each in enumerate(weight))
    return picture


def gaussian(key: int, shape: tuple[int, ...]) -> NDArray:
    """Draw normal numbers of variance 1 that depend on the key alone (Box and Muller, 1958).

    NumPy's Philox generator keeps its bits in all versions; its normal numbers can change.
    """
    count = int(np.prod(shape))
    bits = np.random.Philox(key=key).random_raw(count + count % 2)
    share = ((bits >> np.uint64(11)) + 0.5) * 2.0**-53
    radius = np.sqrt(-2.0 * np.log(share[::2]))
    angle = 2.0 * np.pi * share[1::2]
    return np.concatenate([radius * np.cos(angle), radius * np.sin(angle)])[:count].reshape(shape)
