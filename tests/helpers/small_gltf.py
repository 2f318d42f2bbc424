"""A glTF scene and its page of a small run with hostile names, without Blender."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from firetwin.export import gltf, tracks
from firetwin.export.request import ExportRequest
from firetwin.export.scene_content import Plants, Prototype, SceneContent
from firetwin.shot.shot import Shot
from firetwin.shot.source import ShotSource
from small_run import RUN_TOML, small_fields, write_field

HOSTILE = "</script><script>alert(1)</script>\"' <img src=x onerror=alert(2)> & \u202eabc\u2028 🔥"
SCENE = """\
run = "run"
[time]
start = 2014-09-17T04:45:30Z
end = 2014-09-17T04:47:00Z
frames = 4
[terrain]
near_radius = 0.0
[tiles]
geoid = -24.9
[[cameras]]
name = "drone"
keys = [
  { at = 0.0, latitude = 38.905, longitude = -120.59, height = 400, target = "fire" },
  { at = 1.0, latitude = 38.9, longitude = -120.6, height = 300, target = "fire" },
]
"""
NAME = RUN_TOML.replace('name = "Small"', "name = " + json.dumps(HOSTILE, ensure_ascii=False))
TREES, IDS = 300, 2**24 - 1 - np.arange(300)


def make_content(shot: Shot, request: ExportRequest) -> SceneContent:
    """Trees of two models, the second burned by the fire, and the cameras."""
    rng = np.random.default_rng(5)
    points = np.array([[0, 0, 0], [0.2, 0, 0.5], [0, 0.2, 0.5], [0, 0, 1.0], [0.1, 0, 1.0]], np.float32)
    triangles = np.array([[0, 1, 2], [1, 3, 2], [0, 4, 3]])
    models = [
        Prototype(f"{kind}_00_living_level{level}", kind, "living", level, points, triangles,
                  np.full((3, 3), 0.1 * (level + 1), np.float32), np.array([0, 0, 1]))
        for kind, level in (("large", 1), ("large", 3))
    ]  # fmt: skip
    turn = rng.normal(size=(TREES, 4))
    position = np.column_stack([rng.uniform(-9000, 9000, (TREES, 2)), rng.uniform(0, 900, TREES)])
    nothing = np.zeros(TREES, np.float32)
    arrival = np.where(np.arange(TREES) % 2, rng.uniform(0, 300, TREES), np.inf).astype(np.float32)
    trees = Plants(
        name="Trees",
        position=position.astype(np.float32),
        rotation=(turn / np.linalg.norm(turn, axis=1, keepdims=True)).astype(np.float32),
        scale=rng.uniform(3, 30, (TREES, 3)).astype(np.float32),
        ids=IDS,
        prototype=np.arange(TREES) % 2,
        burned_prototype=np.arange(TREES) % 2,
        burned_from=arrival,
        arrival=arrival,
        scorch=nothing,
        torched=nothing,
    )
    cameras = [replace(each, name=HOSTILE) for each in tracks.find(request)]
    numbers = np.array(request.frames)
    times = np.array([shot.frames.time(frame) for frame in request.frames])
    return SceneContent(numbers, times, 24.0, None, models, [trees], None, cameras, [])


def write(folder: Path) -> tuple[Shot, SceneContent, ExportRequest, Path, Path]:
    """Write scene.glb and index.html into a folder; returns their inputs too."""
    rows, columns = np.ogrid[:8, :10]
    arrival = (30.0 * np.hypot(rows - 3.6, columns - 4.3)).astype(np.float32)
    (folder / "run").mkdir()
    (folder / "run/run.toml").write_text(NAME, encoding="utf-8")
    for name, values in (small_fields() | {"fuel_arrival_time": arrival}).items():
        write_field(folder / "run", name, values, "npy")
    (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
    request = ExportRequest(ShotSource(scene=str(folder / "scene.toml")), "gltf", folder)
    content = make_content(request.shot, request)
    scene, page = gltf.write_content(content, request)
    return request.shot, content, request, scene, page
