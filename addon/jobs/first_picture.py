"""First picture: a coarse one with preview smoke, from the film's scene, while the film's smoke is solved.

It does not change the pictures of the film, is not listed in the manifest, and is removed when the film has
its first picture.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .. import output
from ..shot import picture_credits
from ..shot.shot import Shot
from ..smoke import sources

if TYPE_CHECKING:
    from ..blender.owned import Stage

NAME = "first.png"
_WORTH = 20.0  # s of solving before the first picture from which a coarse one, of 12 processor s, is drawn
_COLUMNS, _SAMPLES = 320, 2


def is_worthwhile(shot: Shot, frame: int) -> bool:
    """Return whether a long solution of smoke precedes a frame.

    Pictures with credits, which a small picture has no room for, and panoramas have no coarse picture.
    """
    if shot.settings.cameras[0].rig.around or picture_credits.of_shot(shot):
        return False
    source = sources.select(shot)
    cost = None if source.is_prepared(frame) else source.cost()
    return cost is not None and cost.first > _WORTH


def write(shot: Shot, stage: Stage, frame: int, out: Path) -> Path | None:
    """Draw a frame of a shot's only camera into a folder; None if a file of others has its name."""
    from ..render import frame_cost
    from ..render.integrated import IntegratedRenderer
    from ..render.picture import Picture

    path = out / NAME
    if os.path.lexists(path) and not output.is_own(path):
        return None
    small = _with_preview(shot)
    source = sources.select(small)
    with source.in_use():
        smoke = source.bricks(frame)
    picture = Picture(small.settings.cameras[0].name, frame, "rgb")

    def draw(part: Path) -> None:
        with _shown(small, stage, frame):
            renderer = IntegratedRenderer(small, stage, frame_cost.FrameCost())
            renderer.frame_renderer(smoke, part.parent)([picture])
        (part.parent / Path(picture.file("png")).name).replace(part)

    output.write(path, draw)
    return path


def remove(out: Path) -> None:
    """Remove the coarse picture from a folder."""
    if output.is_own(out / NAME):
        with contextlib.suppress(OSError):
            (out / NAME).unlink()


def _with_preview(shot: Shot) -> Shot:
    """Return the shot in small pictures with preview smoke; it shares terrain and camera path."""
    settings, (path,) = shot.settings, shot.paths
    width, height = settings.render.resolution
    size = (_COLUMNS, 2 * round(0.5 * height * _COLUMNS / width)) if width > _COLUMNS else (width, height)
    camera = replace(settings.cameras[0], resolution=size)
    small = shot.with_settings(
        replace(
            settings,
            cameras=(camera,),
            smoke=replace(settings.smoke, method=sources.find_preview()),
            render=replace(settings.render, resolution=size, samples=_SAMPLES),
        )
    )
    small.full, small.ground, small.visibility = shot.full, shot.ground, shot.visibility
    small.paths = [replace(path, camera=camera, width=size[0])]
    return small


@contextlib.contextmanager
def _shown(small: Shot, stage: Stage, frame: int) -> Iterator[None]:
    """Show a frame in the size and samples of the small shot during a `with` block."""
    from ..render import engine

    scene = stage.scene
    render, cycles = scene.render, scene.cycles
    before = render.resolution_x, render.resolution_y, cycles.samples
    engine.set_resolution(small.settings, scene)
    cycles.samples = _SAMPLES
    scene.camera = stage.camera(small.settings.cameras[0].name)
    scene.frame_set(frame)
    try:
        yield
    finally:
        render.resolution_x, render.resolution_y, cycles.samples = before
