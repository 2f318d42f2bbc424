"""Shared sections of scene files for tests: settings that build and render fast."""

BARE = """\
[terrain]
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

THREE_FRAMES = """\
run = '{run}'
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = 3
"""

NO_PLANTS = """\
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
trees = false
grass = false
"""

NO_SMOKE = """\
[smoke]
enabled = false
"""

PREVIEW = """\
[smoke]
enabled = {smoke}
method = "preview"
spin_up = 60.0
voxel_size = 120.0
"""

DRONE = """\
[[cameras]]
name = "drone"
keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]
"""

GROUND_ALONE = """\
run = "run"
[time]
frames = 1
[smoke]
enabled = false
[terrain]
near_radius = {near}
apron = {apron}
{key}
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.904
longitude = -120.592
height = 200.0
target = "point"
target_latitude = 38.905
target_longitude = -120.590
"""

PANEL = """\
run = '{run}'
cache = "cache"
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = 3
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
density = "paper"
[fire]
firebrands = 0
[smoke]
enabled = false
[render]
resolution = [64, 36]
samples = 1
video = false
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.825
longitude = -120.56
height = 400.0
target = "fire"
"""
