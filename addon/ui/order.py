"""Places of the panels in the sidebar: the order of work, after Run, Scene and Time."""

SECTIONS, CAMERAS, SENSORS, RENDER, REPORT = 3, 30, 31, 40, 50
