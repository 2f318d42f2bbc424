"""Scene job: builds a shot's scene in a worker process with Blender, and writes it in a format.

A format that needs the scene has a function ``write_content(content, request)``, which runs in the worker.
It can have ``check_blender()``, which raises an Error if this Blender cannot write it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .. import plugins
from ..jobs import worker
from ..jobs.tiles import imagery, selection
from ..progress import MessageCallback, Progress, no_message, silent
from . import formats
from .request import ExportRequest

if TYPE_CHECKING:
    from .scene_content import SmokeLayer

_TILES = ("export", "firetwin export")


def run(request: ExportRequest) -> list[Path]:
    """Build the scene of a request and write it in the worker.

    Raises
    ------
    InputError
        The terms of the scene's tiles or imagery do not allow their export, or a file cannot be written.
    """
    source = request.source
    selection.prepare(source, (), request.progress, request.tell, request.stop, uses=[_TILES])
    imagery.prepare(source, (), request.progress, request.tell, request.stop)
    alone = replace(request, progress=silent, tell=no_message, stop=None)
    return worker.run(partial(in_blender, alone), request.progress, stop=request.stop, tell=request.tell)


def in_blender(request: ExportRequest, progress: Progress, tell: MessageCallback) -> list[Path]:
    """Build the scene and write it; worker side. Returns the main files."""
    from ..jobs import worker_scene
    from ..scene.forest import stand
    from . import read_scene

    request = replace(request, progress=progress, tell=tell)
    module = plugins.module(__package__, request.name)
    if hasattr(module, "check_blender"):
        module.check_blender()
    shot = request.shot
    for text in shot.warnings():
        tell(text)
    wanted = request.smoke and shot.settings.smoke.enabled and formats.known()[request.name].has_smoke
    volumes = _write_volumes(request) if wanted else []
    grown = stand.grow(shot, in_film=False) if shot.settings.forest.trees else None
    stage = worker_scene.build_scene(shot, progress, tell, grown)
    return module.write_content(read_scene.read(shot, stage, request.frames, volumes), request)


def _write_volumes(request: ExportRequest) -> list[SmokeLayer]:
    """Write the missing smoke volumes of frames to the cache, and the temperature of a flow to a folder.

    All smoke is written, not only for the film's views.
    """
    from ..smoke import bake, sources
    from . import smoke_temperature
    from .scene_content import SmokeLayer

    shot, frames = request.shot, list(request.frames)
    smoke = replace(shot.settings.smoke, complete=True)
    every = shot.with_settings(replace(shot.settings, smoke=smoke))
    place = bake.bake(every, request.progress, frames)
    source = sources.select(every)
    layers = [SmokeLayer(each.name) for each in source.layers()]
    for layer, drawn in zip(layers, source.layers(), strict=True):
        files = {frame: drawn.file(place, frame) for frame in frames}
        layer.files.update({frame: file for frame, file in files.items() if file.exists()})
    if source.domains:
        smoke_temperature.write(source, layers, request.folder / "smoke")
    return layers
