"""Places of the panels in the sidebar, after Run, Scene and Time, and titles of those made of the schema."""

from . import keys

SECTIONS, CAMERAS, SENSORS, RENDER, REPORT = 3, 30, 31, 40, 50


def title(section: str) -> str:
    """What the panel of a section of a scene file is called."""
    return {"thermal": "Sensors"}.get(section, keys.label(section))
