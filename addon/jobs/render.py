"""Render what is asked for and not finished, then the films."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..progress import READING, Progress, Tell, count, patience, silent, untold
from ..shot.choice import Choice
from ..shot.shot import Shot
from . import worker


@dataclass(frozen=True)
class Asked:
    """What a render shall make (see `render.plan.pictures`); `resume` keeps what is finished and matches."""

    out: Path
    frames: str | None = None
    camera: str | None = None
    passes: str | None = None
    resume: bool = False


def run(
    choice: Choice,
    asked: Asked,
    progress: Progress = silent,
    tell: Tell = untold,
    stop: worker.Stop | None = None,
) -> int:
    """Render what is asked for and not finished, then the films.

    Returns
    -------
    How many pictures were made.
    """
    from ..render import films, fingerprint, part, plan

    out = asked.out
    with patience(READING):
        shot = choice.shot()
        wanted = plan.pictures(shot, asked.frames, asked.camera, asked.passes)
        made_with = fingerprint.of_pictures(shot.settings, wanted)
        undone = plan.missing(out, wanted, made_with)
    finished = len(wanted) - len(undone)
    if not asked.resume:
        if finished:
            tell(f"rendering {count(finished, 'picture')} again that match; --resume would keep them")
        undone = wanted
    elif finished:
        tell(f"{finished} of {count(len(wanted), 'picture')} are finished and match")
    out.mkdir(parents=True, exist_ok=True)
    if undone:
        cameras = " and ".join(dict.fromkeys(picture.camera for picture in undone))
        tell(f"rendering {count(len(undone), 'picture')} of {cameras}")
    elif not films.missing(shot, out, made_with):
        tell("nothing to render")
        return 0
    task = {
        "choice": choice.plain(),
        "out": str(out.absolute()),
        "pictures": [[picture.camera, picture.frame, picture.name] for picture in undone],
        "filmed": [list(pair) for pair in made_with],
    }
    try:
        eevee = shot.settings.render.engine == "eevee"
        worker.run(f"{__name__}:in_blender", task, progress, eevee=eevee, stop=stop, tell=tell)
    finally:
        part.sweep(out)
    return len(undone)


def in_blender(
    choice: dict[str, str],
    out: str,
    pictures: list[list[Any]],
    filmed: list[list[str]],
    progress: Progress,
    tell: Tell,
) -> None:
    """Render these pictures, each camera in a scene of its own, then films of these cameras and passes."""
    from ..render import fingerprint, video
    from ..render.picture import Picture

    shot = Choice(**choice).shot()
    _check_device(shot)
    todo = [Picture(*picture) for picture in pictures]
    made_with = fingerprint.of_pairs(shot.settings, [(camera, name) for camera, name in filmed])
    frames = len({(picture.camera, picture.frame) for picture in todo})
    done = 0
    for camera, group in itertools.groupby(todo, key=lambda picture: picture.camera):
        wanted = list(group)

        def counted(here: int, of: int, what: str = "", before: int = done) -> None:
            progress(*((before + here, frames) if what == "rendering" else (here, of)), what)

        _camera(shot.of(camera), Path(out), wanted, made_with, counted, tell)
        done += len({picture.frame for picture in wanted})
    video.make(shot, Path(out), made_with, progress)


def _check_device(shot: Shot) -> None:
    """Find out before anything is built whether there is what Cycles shall render on."""
    import bpy

    from ..blender import devices
    from ..errors import Error
    from ..shot import file

    render, path = shot.settings.render, shot.settings.path
    if render.engine != "cycles":
        return
    try:
        devices.take(render.device, bpy.context.scene)
    except Error as error:
        if path.is_file():
            raise file.error_at(path, ("render", "device"), str(error)) from None
        raise


def _camera(shot: Shot, out: Path, wanted: list[Any], made_with: Any, progress: Progress, tell: Tell) -> None:
    """Render the pictures of a shot's one camera; its smoke is baked a frame ahead of them."""
    from ..blender import devices
    from ..render import pictures
    from ..scene.smoke import bake
    from . import setting

    for text in shot.warnings():
        tell(text)
    stage = setting.build_scene(shot, progress, tell)
    if shot.settings.render.engine == "cycles":
        tell(f"Cycles renders on {devices.take(shot.settings.render.device, stage.scene)}")
    with bake.ahead(shot, _smoky(shot, wanted), progress, tell) as ready:
        pictures.render(shot, stage, out, wanted, made_with, progress, ready)


def _smoky(shot: Shot, wanted: list[Any]) -> list[int]:
    """Frames of pictures that show smoke, ascending."""
    from ..shot import passes

    if not shot.settings.smoke.enabled:
        return []
    known = passes.known()
    names = {name for name, each in known.items() if "smoke" in each.aspects}
    return sorted({picture.frame for picture in wanted if picture.name in names})
