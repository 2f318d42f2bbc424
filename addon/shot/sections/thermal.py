"""Section [thermal]: the infrared camera."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import Where, key

BANDS = {"lwir": (8.0, 14.0), "mwir": (3.4, 4.1)}  # um, of infrared cameras


@dataclass(frozen=True)
class Thermal:
    """The simulated infrared camera of the thermal passes. By default the detector is ideal."""

    band: str = key(
        "lwir",
        "wavelength band",
        choices={"lwir": "long-wave, 8 to 14 µm", "mwir": "mid-wave, 3.4 to 4.1 µm"},
    )
    palette: str = key(
        "white-hot",
        "colour palette of the picture",
        choices=("white-hot", "black-hot", "ironbow", "inferno"),
    )
    vapour: float = key(
        10.0,
        "absolute humidity at sea level (path attenuation); 0: no attenuation",
        unit="g/m³",
        at_least=0,
        at_most=40,
    )
    blur: float = key(
        0.0, "standard deviation of the point spread function", unit="pixels", at_least=0, at_most=20
    )
    noise: float = key(
        0.0, "noise-equivalent temperature difference (NETD) at 300 K", unit="K", at_least=0, at_most=100
    )
    saturation: float = key(
        0.0, "detector saturation temperature; 0: no limit", unit="K", at_least=0, at_most=3000
    )
    bits: int = key(
        0, "bit depth of counts in the EXR, up to saturation; 0: no counts", at_least=0, at_most=16
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that counts have an upper end."""
        if self.bits and not self.saturation:
            return ("bits",), "thermal.bits needs thermal.saturation, which fills the range of the counts"
        return None
