"""The long jobs, for the command line and for Blender's window alike: each has a process of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import worker
from .choice import Choice
from .progress import Progress, silent
from .wording import count

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from .project import Project


@dataclass(frozen=True)
class Asked:
    """What a render shall make (see `render.plan.shots`); `resume` keeps what is finished and matches."""

    out: Path
    frames: str = ""
    camera: str | None = None
    passes: str | None = None
    resume: bool = False


def build(choice: Choice, out: Path, progress: Progress = silent, stop: worker.Stop | None = None) -> None:
    """Build the scene and save it as `out`, a .blend file."""
    choice.load()
    out = out.absolute()
    out.parent.mkdir(parents=True, exist_ok=True)
    task = {"choice": choice.plain(), "out": str(out)}
    worker.run(f"{__name__}:build_in_blender", task, progress, stop=stop)


def bake(choice: Choice, progress: Progress = silent, stop: worker.Stop | None = None) -> Path | None:
    """Write the smoke volumes of the whole shot that are not there; their folder, None without smoke."""
    project, _ = choice.load()
    if not project.smoke.enabled:
        return None
    return Path(worker.run(f"{__name__}:bake_in_blender", {"choice": choice.plain()}, progress, stop=stop))


def render(
    choice: Choice,
    asked: Asked,
    progress: Progress = silent,
    tell: Callable[[str], None] = lambda text: None,
    stop: worker.Stop | None = None,
) -> int:
    """Render what is asked for and not finished, then the films.

    Parameters
    ----------
    tell
        Called with a sentence about what is going to be done.

    Returns
    -------
    How many pictures were made.
    """
    from .render import films, part, plan, settings

    project, run = choice.load()
    out = asked.out
    wanted = plan.shots(project, asked.frames, asked.camera, asked.passes)
    made_with = settings.by_shot(project, wanted)
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
        cameras = " and ".join(dict.fromkeys(shot.camera for shot in undone))
        tell(f"rendering {count(len(undone), 'picture')} of {cameras}")
    elif not films.missing(project, run, out, made_with):
        tell("nothing to render")
        return 0
    task = {
        "choice": choice.plain(),
        "out": str(out.absolute()),
        "shots": [[shot.camera, shot.frame, shot.name] for shot in undone],
        "filmed": [list(pair) for pair in made_with],
    }
    try:
        eevee = project.render.engine == "eevee"
        worker.run(f"{__name__}:render_in_blender", task, progress, eevee=eevee, stop=stop)
    finally:
        part.sweep(out)
    return len(undone)


# What follows runs in the worker process, where Blender is.


def build_in_blender(choice: dict[str, str], out: str, progress: Progress) -> None:
    """Build the scene and save it under a temporary name that it then loses."""
    import bpy

    project, run = Choice(**choice).load()
    _built(project, run, progress)
    part = Path(out).with_suffix(".part.blend")
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(part), compress=True, relative_remap=False)
    part.replace(out)


def bake_in_blender(choice: dict[str, str], progress: Progress) -> str:
    """Bake and return the folder of the volumes."""
    from .scene import bake

    return str(bake.bake(*Choice(**choice).load(), progress))


def render_in_blender(
    choice: dict[str, str], out: str, shots: list[list[Any]], filmed: list[list[str]], progress: Progress
) -> None:
    """Render these shots, then make the films of these cameras and passes."""
    from .render import frames, passes, settings, video

    project, run = Choice(**choice).load()
    todo = [passes.Shot(*shot) for shot in shots]
    made_with = settings.of_pairs(project, [(camera, name) for camera, name in filmed])
    if todo:
        smoky = sorted({shot.frame for shot in todo if shot.name != "depth"})
        scene = _built(project, run, progress, smoky)
        frames.render(project, run, scene, Path(out), todo, made_with, progress)
    video.make(project, run, Path(out), made_with, progress)


def _built(project: Project, run: Run, progress: Progress, frames: list[int] | None = None) -> Any:
    """An otherwise empty Blender with the scene in it, and the smoke of these frames (all) on disk."""
    import bpy

    from .render import engine
    from .scene import bake, build

    # Not read_factory_settings: its preferences enable no extension, and Blender then deletes their wheels.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    if project.smoke.enabled and frames != []:
        bake.bake(project, run, progress, frames)
    progress(0, 1, "building the scene")
    scene = build.build(project, run)
    engine.apply(project, scene)
    progress(1, 1, "building the scene")
    return scene
