"""Scene job: builds a shot's scene in a worker process with Blender, and writes it in a format.

A format that needs the scene has a function ``write_content(content, export)``, which runs in the worker.
It can have ``check_blender()``, which raises an Error if this Blender cannot write it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import plugins
from ..jobs import worker
from ..jobs.tiles import imagery, selection
from ..progress import MessageCallback, Progress
from ..shot import georeference
from ..shot.georeference import Georeference
from ..shot.shot import Shot
from ..shot.source import ShotSource
from . import formats

if TYPE_CHECKING:
    from .request import ExportRequest
    from .scene_content import SmokeLayer

_TILES = ("export", "firetwin export")


@dataclass(frozen=True)
class SceneExport:
    """Input of `write_content` in addition to the scene's content: see `request.ExportRequest`."""

    shot: Shot
    georeference: Georeference
    folder: Path
    progress: Progress


def run(request: ExportRequest, writer: str) -> list[Path]:
    """Build the scene of a request and write it with the module `writer` of this package.

    Raises
    ------
    InputError
        The terms of the scene's tiles or imagery do not allow their export, or a file cannot be written.
    """
    source, place = request.source, request.georeference
    selection.prepare(source, (), request.progress, request.tell, request.stop, uses=[_TILES])
    imagery.prepare(source, (), request.progress, request.tell, request.stop)
    task = {
        "choice": source.plain(),
        "writer": writer,
        "frames": list(request.frames),
        "folder": str(request.folder),
        "geoid": [place.geoid_m, place.source, place.orthometric],
        "smoke": request.smoke,
    }
    names = worker.run(f"{__name__}:in_blender", task, request.progress, stop=request.stop, tell=request.tell)
    return [request.folder / name for name in names]


def in_blender(
    choice: dict[str, str],
    writer: str,
    frames: list[int],
    folder: str,
    geoid: list[Any],
    smoke: bool,
    progress: Progress,
    tell: MessageCallback,
) -> list[str]:
    """Build the scene and write it; worker side. Returns names of the main files in the folder."""
    from ..jobs import worker_scene
    from . import read_scene

    module = plugins.module(__package__, writer)
    if hasattr(module, "check_blender"):
        module.check_blender()
    shot = ShotSource(**choice).shot()
    for text in shot.warnings():
        tell(text)
    wanted = smoke and shot.settings.smoke.enabled and formats.known()[writer].has_smoke
    volumes = _write_volumes(shot, frames, Path(folder), progress) if wanted else []
    place = georeference.Georeference(shot.local_frame, *geoid)
    stage = worker_scene.build_scene(shot, progress, tell)
    content = read_scene.read(shot, stage, frames, volumes)
    export = SceneExport(shot, place, Path(folder), progress)
    made = module.write_content(content, export)
    return [path.relative_to(folder).as_posix() for path in made]


def _write_volumes(shot: Shot, frames: list[int], folder: Path, progress: Progress) -> list[SmokeLayer]:
    """Write the missing smoke volumes of frames to the cache, and the temperature of a flow to a folder.

    All smoke is written, not only for the film's views.
    """
    from ..smoke import bake, sources
    from . import smoke_temperature
    from .scene_content import SmokeLayer

    smoke = replace(shot.settings.smoke, complete=True)
    every = shot.with_settings(replace(shot.settings, smoke=smoke))
    place = bake.bake(every, progress, frames)
    source = sources.select(every)
    layers = [SmokeLayer(each.name) for each in source.layers()]
    for layer, drawn in zip(layers, source.layers(), strict=True):
        files = {frame: drawn.file(place, frame) for frame in frames}
        layer.files.update({frame: file for frame, file in files.items() if file.exists()})
    if source.domains:
        smoke_temperature.write(source, layers, folder / "smoke")
    return layers
