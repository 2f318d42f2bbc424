"""Parts of scene files that tests share: what makes a scene quick to build and to render."""

BARE = """\
[ground]
near_radius = 0.0
apron = 20000.0
[forest]
density = "paper"
"""

TINY = """\
[render]
resolution = [64, 36]
samples = 1
denoise = false
"""
