"""glTF scene: `scene.glb` with terrain, forest, fronts, cameras and places, and a viewer page, `index.html`.

The scene is in metres with y up; x is east and z south. Its extras have the place on the Earth, the clock and
the credits. Trees and ground are as before the fire, with arrival times.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import firetwin_core
import numpy as np

from .. import files
from ..run import times
from ..shot import picture_credits
from ..stations.records import EXERCISE
from . import fronts, gltf_cameras, gltf_forest, gltf_fronts, gltf_terrain, places, viewer_page
from .gltf_document import TO_Y_UP, Document
from .places import Place
from .request import ExportRequest
from .scene_content import SceneContent
from .viewer_page import PageText

FORMAT = {"title": "glTF", "help": "glTF scene with instanced trees, and a viewer page"}
ORDER = 20
NAME, PAGE = "scene.glb", "index.html"
_SYNTHETIC = "This scene is synthetic, not the output of a fire model."


def write_content(content: SceneContent, request: ExportRequest) -> list[Path]:
    """Write the scene of a scene's content, and its page; return both files."""
    found = places.find(request.shot)
    scene = encode(content, request, found)
    page = viewer_page.html(scene, _page_text(request, found))
    (request.folder / NAME).write_bytes(scene)
    files.write_text(request.folder / PAGE, page)
    return [request.folder / NAME, request.folder / PAGE]


def encode(content: SceneContent, request: ExportRequest, named_places: list[Place]) -> bytes:
    """Encode the scene as .glb."""
    shot = request.shot
    first, last = (float(shot.run.times[at]) for at in (0, -1))
    document = Document(shot.run.name, picture_credits.of_shot(shot).text())
    gltf_terrain.add(document, shot, (first, last))
    gltf_forest.add(document, content, first)
    gltf_fronts.add(document, shot, fronts.of_shot(shot, content.frames.tolist()), first)
    gltf_cameras.add(document, content)
    _add_places(document, request, named_places)
    return document.encode({"firetwin": describe(content, request)})


def describe(content: SceneContent, request: ExportRequest) -> dict[str, Any]:
    """Describe a scene: origin of the data, clock, credits and place on the Earth.

    Times in s count from `start_utc`, the start of the run. `gltf_to_ecef` is a matrix in glTF's order, by
    columns, from the file's positions to Earth-centred metres (EPSG:4978).
    """
    shot, place = request.shot, request.georeference
    start = float(shot.run.times[0])
    matrix = place.matrix.copy()
    matrix[:3, :3] = matrix[:3, :3] @ TO_Y_UP.T
    return {
        "version": firetwin_core.__version__,
        "run": shot.run.name,
        "synthetic": bool(shot.run.synthetic),
        "credits": picture_credits.of_shot(shot).text(),
        "axes": "x east, y up, z south, m",
        "start_utc": times.iso(times.utc(shot.run, start)),
        "end_s": float(shot.run.times[-1]) - start,
        "zone": shot.settings.time.zone,
        "frames": content.frames.tolist(),
        "frame_times_s": (np.asarray(content.times) - start).tolist(),
        "rate": content.rate,
        "gltf_to_ecef": matrix.T.ravel().tolist(),
        "georeference": place.as_json(),
    }


def _add_places(document: Document, request: ExportRequest, found: list[Place]) -> None:
    """Append named places as nodes on the ground."""
    if not found:
        return
    parent = document.node("places")
    for place in found:
        point = request.shot.ground.point(place.latitude, place.longitude)[0] @ TO_Y_UP.T
        extras = {
            "title": place.name,
            "kind": place.kind,
            "symbol": place.symbol,
            "lines": list(place.lines),
            "exercise": place.exercise,
        }
        document.node(place.name, parent, translation=point.tolist(), extras=extras)


def _page_text(request: ExportRequest, found: list[Place]) -> PageText:
    shot, place = request.shot, request.georeference
    marks = [("SYNTHETIC", _SYNTHETIC)] if shot.run.synthetic else []
    if any(each.exercise for each in found):
        marks.append(("EXERCISE", f"{EXERCISE}."))
    facts = [
        ("Run", shot.run.name),
        (
            "Origin",
            f"{place.latitude:.6f}, {place.longitude:.6f}, {place.height:.2f} m above the WGS84 ellipsoid",
        ),
        ("Heights of the run", str(place.as_json()["model_datum"])),
        ("Height of the geoid", f"{place.geoid_m:.2f} m ({place.source})"),
    ]
    return PageText(shot.run.name, marks, facts, picture_credits.of_shot(shot).text())
