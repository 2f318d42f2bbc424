"""Fused pass: visible, thermal, depth and map panels of a camera in one picture, with time and position.

The picture has the camera's size, and at least 720 rows for legibility. Depth has the same colours in every
frame of a shot; temperatures have the colours of the thermal pass. Sensors on the camera's mount supply
passes that it does not record (see `shot.cameras.mount`). All panels are registered: a point has the same
position in each. A sensor with a smaller field of view fills its part of the panel and is outlined in the
visible picture. The map is the picture of a minimap that follows the camera; else relief and canopy of the
run, north up, around the camera. It shows the front, the burned area (the last half hour in orange), the
camera, its path and field of view.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="fused",
    order=60,
    help="One picture of visible, thermal, depth and a map, with time, place and scales",
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "terrain", "thermal"}),
    needs=("rgb", "thermal", "depth"),
    mount=True,
    single_view=True,
    min_rows=720,
    code=("shot/cameras/rigs/mounted.py", "shot/cameras/rigs/minimap.py", "render/finish/pose.py"),
)
