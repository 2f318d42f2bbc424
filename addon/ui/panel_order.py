"""Order of the sidebar's panels after Run, Scene and Time, and titles of the generated panels."""

from . import keys

SECTIONS, CAMERAS, SENSORS, RENDER, REPORT = 3, 30, 31, 40, 50


def title(section: str) -> str:
    """Return the panel title of a section of a scene file."""
    return {"thermal": "Sensors"}.get(section, keys.label(section))
