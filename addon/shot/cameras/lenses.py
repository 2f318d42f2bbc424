"""Lens presets: focal length and sensor width of real camera types.

Names are of types, not of products. Figures come from the named data sheet; without one they are typical.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Lens:
    """A camera type: focal length and sensor width in mm, and the source of the figures."""

    name: str
    focal_length: float
    sensor_width: float
    source: str

    @property
    def about(self) -> str:
        """Describe the figures in one line."""
        return f"{self.focal_length:g} mm on a chip {self.sensor_width:g} mm wide; {self.source}"


LENSES = {
    "small_drone": Lens("Small drone", 4.5, 6.4, "typical of 1/2.3 inch chips, 71 degrees wide"),
    "inch_drone": Lens("Drone with a 1 inch chip", 8.8, 13.2, "13.2 x 8.8 mm, 74 degrees wide: usual"),
    "film_drone": Lens("Film drone, 4/3 chip", 12.3, 17.3, "Four Thirds, 17.3 x 13 mm; 24 mm equivalent"),
    "survey_drone": Lens("Survey drone, full frame", 35.0, 35.9, "typical of mapping payloads"),
    "tele_drone": Lens("Drone's long lens", 30.0, 6.4, "typical of zoom payloads, 12 degrees wide"),
    "thermal_drone": Lens("Drone's thermal, 640 x 512", 13.6, 7.68, "12 um pixels, 32 degrees wide: typical"),
    "thermal_wide": Lens("Drone's wide thermal, 640 x 512", 9.1, 7.68, "12 um pixels, 46 degrees: typical"),
    "thermal_small": Lens("Small thermal, 160 x 120", 1.77, 1.92, "12 um pixels, 57 degrees wide: typical"),
    "thermal_hand": Lens("Hand-held thermal, 320 x 240", 9.8, 5.44, "17 um pixels, 31 degrees: typical"),
    "line_scan": Lens("Aircraft's infrared, 640 x 512", 25.0, 9.6, "15 um pixels, 22 degrees: typical"),
    "lookout": Lens("Lookout camera", 4.7, 4.8, "typical of pan and tilt cameras, 54 degrees wide"),
    "wide": Lens("Full frame, wide", 24.0, 36.0, "36 x 24 mm, 74 degrees wide"),
    "normal": Lens("Full frame, normal", 50.0, 36.0, "36 x 24 mm, 40 degrees wide"),
    "long": Lens("Full frame, long", 200.0, 36.0, "36 x 24 mm, 10 degrees wide"),
}
"""Lens presets by their name in scripts."""
