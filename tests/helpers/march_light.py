"""Light of a march without any source."""

NO_LIGHT = {
    "density": 1.0,
    "fresh": (0.0, 0.0, 0.0),
    "old": (0.0, 0.0, 0.0),
    "sun": (0.0, 0.0, 0.0),
    "sky": (0.0, 0.0, 0.0),
    "sun_direction": (0.0, 0.0, 1.0),
    "anisotropy": 0.0,
    "multiple_scattering": (0.0, 0.0),
    "glow": (0.0, 0.0, 0.0),
    "thin": 1.0,
    "air": (0.0, 0.0, 0.0),
    "horizon": (0.0, 0.0, 0.0),
    "thick_haze": (0.2, 1.2),
    "haze": (0.0, 0.0),
    "haze_height": (5000.0, 800.0),
}
