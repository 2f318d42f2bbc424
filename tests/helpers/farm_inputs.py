"""A scene that names a file of every kind of input, all in its folder, and files that it does not name."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
from rasters import write_tiff
from scene_text import TINY

BOX = (-120.59, 38.81, -120.51, 38.87)  # west, south, east, north, within the run of small_scene
TIMES = ("2014-09-17T21:00:00Z", "2014-09-17T21:30:00Z", "2014-09-17T22:00:00Z")
SCENE = (
    """\
run = "run"
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T22:00:00Z
frames = 3
[terrain]
near_radius = 500.0
apron = 20000.0
elevation = "terrain/dem.tif"
photo = "terrain/photo.png"
land_use = "land.geojson"
[forest]
trees = false
grass = false
[fire]
observed = "observed"
[smoke]
voxel_size = 120.0
[labels]
enabled = true
file = "places.csv"
"""
    + TINY
    + """\
passes = ["rgb"]
[[cameras]]
name = "drone"
frames = "3"
track = "tracks/flown.gpx"
[[cameras]]
name = "other"
frames = "3"
track = "tracks/flown.csv"
track_times = "shot"
"""
)
NAMED = (
    "terrain/dem.tif",
    "terrain/photo.png",
    "terrain/photo.pgw",
    "land.geojson",
    "observed/seen.geojson",
    "places.csv",
    "tracks/flown.gpx",
    "tracks/flown.csv",
)
"""Files that the scene names, with the one that belongs to the photo."""


def write(folder: Path, run: Path) -> Path:
    """Write the scene and all that it reads below a folder; the scene file."""
    from firetwin.run import opening as runs

    for part in ("terrain", "observed", "tracks"):
        (folder / part).mkdir(parents=True)
    shutil.copytree(run, folder / "run", ignore=shutil.ignore_patterns(".*"))
    opened = runs.open(run)
    levels = opened.elevation + np.linspace(10.0, 3000.0, 12, dtype=np.float32)[:, None, None]
    smoke = np.zeros((len(opened.times), *levels.shape), np.float32)
    smoke[:, 4:8, 8:16, 8:16] = 1.0e-6
    np.save(folder / "run/height_3d.npy", levels)
    np.save(folder / "run/smoke_3d.npy", smoke)
    write_tiff(folder / "terrain/dem.tif", lambda y, x: 1500.0 + 2e3 * (y - 38.8), step=60.0, box=BOX)
    _photo(folder / "terrain/photo.png")
    _write(folder / "land.geojson", _polygon(BOX[0], BOX[1], -120.55, 38.82, kind="field"))
    _write(folder / "observed/seen.geojson", _polygon(-120.56, 38.83, -120.54, 38.85, time=TIMES[1]))
    places = [(38.825 + 0.002 * k, -120.56 + 0.002 * k, 1800.0 + 20.0 * k) for k in range(3)]
    (folder / "places.csv").write_text("name,latitude,longitude\nFirst,38.84,-120.55\n")
    (folder / "tracks/flown.gpx").write_text(_gpx(places))
    rows = (f"{time},{y},{x},{h}" for time, (y, x, h) in zip(TIMES, places, strict=True))
    (folder / "tracks/flown.csv").write_text("\n".join(("time,latitude,longitude,altitude (m)", *rows)))
    for other in ("notes.txt", "run/notes.txt", "terrain/other.tif"):
        (folder / other).write_text("not read")
    path = folder / "scene.toml"
    path.write_text(SCENE)
    return path


def _photo(path: Path) -> None:
    from PIL import Image

    west, _, east, north = BOX
    step = (east - west) / 64
    y, x = np.mgrid[:48, :64]
    pixels = np.stack([x * 4, y * 5, 255 - x * 2], axis=-1).astype(np.uint8)
    Image.fromarray(pixels).save(path)
    lines = (step, 0.0, 0.0, -step, west + 0.5 * step, north - 0.5 * step)
    path.with_suffix(".pgw").write_text("\n".join(map(str, lines)))


def _polygon(west: float, south: float, east: float, north: float, **properties: str) -> dict[str, object]:
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


def _write(path: Path, *features: dict[str, object]) -> None:
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))


def _gpx(places: list[tuple[float, float, float]]) -> str:
    points = "".join(
        f'<trkpt lat="{y}" lon="{x}"><ele>{h}</ele><time>{time}</time></trkpt>'
        for time, (y, x, h) in zip(TIMES, places, strict=True)
    )
    return f'<?xml version="1.0"?><gpx xmlns="http://x"><trk><trkseg>{points}</trkseg></trk></gpx>'
