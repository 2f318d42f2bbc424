"""USD stage: `scene.usda` over a layer each for terrain, forest, fire, smoke, cameras and stations.

The layers are written by `pxr` from arrays. Blender's own exporter took 60 s for the example, copied 9,315
meshes, and left out tree numbers, materials, all smoke but one frame, and the place on the Earth.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import firetwin_core
import numpy as np

from ..scene.terrain import ground_picture
from . import places, usd_library
from .request import ExportRequest
from .scene_content import SceneContent

FORMAT = {"title": "USD", "help": "USD stage: terrain, forest, fire, smoke, cameras", "has_smoke": True}
ORDER = 10
NAME = "scene.usda"
PICTURES = 5
"""Number of pictures of the ground, at most."""


def check_blender() -> None:
    """Check that this Blender has a USD library, before the scene is built.

    Raises
    ------
    Error
        It has none.
    """
    usd_library.load()


def write_content(content: SceneContent, request: ExportRequest) -> list[Path]:
    """Write the stage of a scene's content, and return its main file."""
    check_blender()
    from . import usd_cameras, usd_fire, usd_forest, usd_places, usd_smoke, usd_terrain

    out, layers = request.folder, list[Path]()
    if content.terrain is not None:
        times = dict(zip(content.frames.tolist(), content.times.tolist(), strict=True))
        frames = usd_forest.burning_frames(content, PICTURES)
        pictures = ground_picture.paint(request.shot, np.array([times[frame] for frame in frames]))
        layers.append(usd_terrain.write(content, out, dict(zip(frames, pictures, strict=True))))
    if content.plants:
        layers.append(usd_forest.write(content, out))
    if content.flames is not None:
        layers.append(usd_fire.write(content, out))
    if content.smoke:
        layers.append(usd_smoke.write(content, out, request.shot))
    if content.cameras:
        layers.append(usd_cameras.write(content, out))
    if found := places.find(request.shot):
        layers.append(usd_places.write(content, out, request.shot, found))
    return [_write_scene(content, request, layers)]


def _write_scene(content: SceneContent, request: ExportRequest, layers: list[Path]) -> Path:
    """Write the file that combines the layers, with the place on the Earth and the origin of the data."""
    from . import usd_georeference

    path = request.folder / NAME
    span = int(content.frames[0]), int(content.frames[-1])
    stage = usd_library.new_stage(path, content.rate, span)
    usd_library.set_kind(stage.GetDefaultPrim(), "assembly")
    stage.GetRootLayer().subLayerPaths = [f"./{layer.name}" for layer in layers]
    usd_georeference.define(stage, request.georeference)
    layer = stage.GetRootLayer()
    layer.customLayerData = origin(request)
    layer.documentation = "Firetwin scene: x east, y north, z up, metres; a time code is a frame of the film"
    layer.Save()
    return path


def origin(request: ExportRequest) -> dict[str, Any]:
    """Return the origin of the data: run, model times, datum, version and credits."""
    from ..shot import picture_credits

    shot, run = request.shot, request.shot.run
    data = {
        "run": run.name,
        "synthetic": bool(run.synthetic),
        "scene_file": shot.settings.path.name,
        "first_frame_utc": shot.utc(1).isoformat(),
        "seconds_per_frame": shot.frames.step,
        "heights": request.georeference.as_json()["model_datum"],
        "geoid_m": request.georeference.geoid_m,
        "credits": picture_credits.of_shot(shot).text(),
        "version": firetwin_core.__version__,
    }
    return {"firetwin": data}
