"""Memory and time of files at the limits of docs/limits.md, and the message just above them.

    .venv/bin/python tests/benchmarks/limits_at_edge.py RUN [CASE ...]

Each case is a separate command; the largest of its processes counts. RUN is a run folder; its ground is bare.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from firetwin import limits
from firetwin.run import readers

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import small_stations
import tilesets

SCENE = """\
run = "{run}"
[time]
frames = 1
[smoke]
enabled = false
[forest]
trees = false
grass = false
[[cameras]]
keys = [{{latitude = {latitude}, longitude = {longitude}, height = 400, target = "fire"}}]
"""


class Case(NamedTuple):
    """A limit: counts at and above it, and a function that writes files of a count and returns a command."""

    write: Callable[[Path, Path, int], list[str]]
    at: int
    above: int


def scene(folder: Path, run: Path, more: str = "") -> list[str]:
    """Write a scene file and return the command that builds it."""
    latitude, longitude = places(run, 1)[0]
    text = SCENE.format(run=run, latitude=latitude, longitude=longitude)
    (folder / "scene.toml").write_text(text + more)
    return ["build", str(folder / "scene.toml"), "-o", str(folder / "scene.blend")]


def places(run: Path, count: int) -> np.ndarray:
    """Random places (count, 2) in the middle of a run: latitude and longitude, degrees."""
    axes = readers.open(run)
    low, high = (np.quantile([axes.latitude, axes.longitude], share, axis=1) for share in (0.3, 0.7))
    return np.random.default_rng(1).uniform(low, high, (count, 2))


def labels(folder: Path, run: Path, count: int) -> list[str]:
    """Labels in a scene."""
    rows = "".join(f"Place {k},{x},{y}\n" for k, (x, y) in enumerate(places(run, count)))
    (folder / "labels.csv").write_text(f"name,latitude,longitude\n{rows}")
    return scene(folder, run, '[labels]\nenabled = true\nfile = "labels.csv"\n')


def signs(folder: Path, run: Path, count: int) -> list[str]:
    """Station signs in a scene."""
    rows = [(f"Station {k}", *place) for k, place in enumerate(places(run, count).tolist())]
    small_stations.briefed(folder / "stations.gpkg", rows)
    return scene(folder, run, '[stations]\nenabled = true\nfile = "stations.gpkg"\n')


def routes(folder: Path, run: Path, length: int) -> list[str]:
    """Length of all routes, km, in as many lines as there may be, back and forth within the run."""
    count, parts = limits.ROUTES, limits.ROUTE_CORNERS // limits.ROUTES
    north = (
        length / (count * (parts - 1)) / 111.32
    )  # degrees; a degree has 111.32 km on the sphere of the limit
    lines = [[[x, y + north * (k % 2)] for k in range(parts)] for y, x in places(run, count).tolist()]
    (folder / "routes.geojson").write_text(json.dumps({"type": "MultiLineString", "coordinates": lines}))
    return scene(folder, run, '[stations]\nenabled = true\nroutes_file = "routes.geojson"\n')


def rings(folder: Path, run: Path, corners: int, count: int) -> Path:
    """Write footprints with so many corners each."""
    angle = np.linspace(0.0, 2.0 * np.pi, corners + 1)[:-1, None]
    circle = 2e-4 * np.hstack([np.cos(angle), np.sin(angle)])
    with (folder / "houses.geojson").open("w") as file:
        for k, (latitude, longitude) in enumerate(places(run, count)):
            ring = (circle + np.array([longitude, latitude])).round(8).tolist()
            shape = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
            head = '{"type": "FeatureCollection", "features": [' if k == 0 else ", "
            file.write(head + json.dumps({"type": "Feature", "properties": {}, "geometry": shape}))
        file.write("]}")
    return folder / "houses.geojson"


def corners(folder: Path, run: Path, count: int) -> list[str]:
    """Corners of one footprint."""
    rings(folder, run, count, 1)
    return scene(folder, run, '[terrain]\nbuildings = "houses.geojson"\n')


def all_corners(folder: Path, run: Path, count: int) -> list[str]:
    """Corners of all footprints."""
    rings(folder, run, limits.CORNERS, count)
    return scene(folder, run, '[terrain]\nbuildings = "houses.geojson"\n')


def geojson(folder: Path, run: Path, count: int) -> list[str]:
    """GeoJSON of short numbers, the densest text; its head has 5 values."""
    text = '{"type":"LineString","coordinates":[[1,2]' + ",[1,2]" * ((count - 5) // 3) + "]}"
    (folder / "a.geojson").write_text(text)
    return ["score", str(run), "--against", f"{folder / 'a.geojson'}@2014-09-18T04:00Z"]


def tileset(folder: Path, run: Path, size: int) -> list[str]:
    """JSON of empty objects in a tileset."""
    text = json.dumps(tilesets.tileset(tilesets.tile()))[:-1] + ', "extras": [{}'
    count = (size - len(text) - 2) // 3
    (folder / "tileset.json").write_text(
        text + ",{}" * count + "]}" + " " * (size - len(text) - 2 - 3 * count)
    )
    return ["tiles", "info", str(folder)]


CASES = {
    "scene without them": Case(lambda folder, run, _: scene(folder, run), 0, 0),
    "labels": Case(labels, limits.LABELS, limits.LABELS + 1),
    "station signs": Case(signs, limits.SIGNS, limits.SIGNS + 1),
    "length of routes": Case(routes, int(0.99 * limits.ROUTE_KM), int(1.01 * limits.ROUTE_KM)),
    "corners of a footprint": Case(corners, limits.CORNERS, limits.CORNERS + 1),
    "footprints of most corners": Case(
        all_corners,
        limits.FOOTPRINT_CORNERS // limits.CORNERS,
        limits.FOOTPRINT_CORNERS // limits.CORNERS + 1,
    ),
    "values of GeoJSON": Case(geojson, limits.TEXT_VALUES, limits.TEXT_VALUES + 3),
    "bytes of a tileset.json": Case(tileset, limits.TILE_JSON_BYTES, limits.TILE_JSON_BYTES + 1),
}


def measure(words: list[str], folder: Path) -> tuple[float, float, str]:
    """Run a command; return processor seconds, peak MiB of its largest process, and its last line."""
    with (folder / "log").open("w+") as log:
        child = subprocess.Popen([sys.executable, "-m", "firetwin", *words], stdout=log, stderr=log)
        _, _, used = os.wait4(child.pid, 0)
        log.seek(0)
        lines = log.read().replace(str(folder), "").splitlines() or [""]
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, lines[-1]


def main() -> None:
    """Print the table."""
    run, wanted = Path(sys.argv[1]).absolute(), sys.argv[2:] or list(CASES)
    print("| limit | number | processor s | MiB | last line |\n| --- | --- | --- | --- | --- |")
    for name in wanted:
        case = CASES[name]
        for count in dict.fromkeys((case.at, case.above)):
            with tempfile.TemporaryDirectory() as place:
                seconds, peak, said = measure(case.write(Path(place), run, count), Path(place))
            print(f"| {name} | {count:,} | {seconds:.1f} | {peak:,.0f} | {said[:140]} |", flush=True)


if __name__ == "__main__":
    main()
