"""What each command of `cli` does; heavy modules are imported by the command that needs them."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .progress import Progress, Reporter, say

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from .project import Project


def sample(arguments: argparse.Namespace) -> None:
    """Write the sample run."""
    from .data import sample

    say(f"writing the synthetic King-like run to {arguments.out}")
    sample.write(arguments.out, arguments.frames, arguments.format, Reporter("model times"))
    print(arguments.out)


def info(arguments: argparse.Namespace) -> None:
    """Show what is in a run."""
    from . import info
    from .project import Time

    facts = info.gather(_open(arguments.run), Time().zone)
    if arguments.json:
        json.dump(facts, sys.stdout, indent=1)
        print()
    else:
        print(info.page(facts))


def maps(arguments: argparse.Namespace) -> None:
    """Draw the maps of a run."""
    run = _open(arguments.run)
    say("drawing the fuel map and the fire intensity map")
    from . import maps
    from .project import Time

    for path in maps.draw(run, arguments.out, Time().zone):
        print(path)


def build(arguments: argparse.Namespace) -> None:
    """Build the scene and save it."""
    from . import worker
    from .errors import UsageError

    out = arguments.out.absolute()
    if out.suffix != ".blend":
        raise UsageError(f"-o: {arguments.out} does not end in .blend")
    project, _ = _load(arguments.scene)
    out.parent.mkdir(parents=True, exist_ok=True)
    worker.run(f"{__name__}:build_in_blender", {"scene": str(project.path), "out": str(out)}, Reporter())
    print(arguments.out)


def bake(arguments: argparse.Namespace) -> None:
    """Write the smoke volumes."""
    from . import worker

    project, _ = _load(arguments.scene)
    if not project.smoke.enabled:
        say("this scene has no smoke ([smoke] enabled = false), so there is nothing to bake")
        return
    print(worker.run(f"{__name__}:bake_in_blender", {"scene": str(project.path)}, Reporter("smoke")))


def render(arguments: argparse.Namespace) -> None:
    """Render what is asked for and not finished, then the films."""
    from . import worker
    from .render import films, part, plan, settings

    project, run = _load(arguments.scene)
    out = arguments.out
    wanted = plan.shots(project, arguments.frames, arguments.camera, arguments.passes)
    made_with = settings.by_shot(project, wanted)
    undone = plan.missing(out, wanted, made_with)
    finished = len(wanted) - len(undone)
    if not arguments.resume:
        if finished:
            say(f"rendering {_count(finished, 'picture')} again that match; --resume would keep them")
        undone = wanted
    elif finished:
        say(f"{finished} of {_count(len(wanted), 'picture')} are finished and match")
    out.mkdir(parents=True, exist_ok=True)
    if undone:
        cameras = " and ".join(dict.fromkeys(shot.camera for shot in undone))
        say(f"rendering {_count(len(undone), 'picture')} of {cameras}")
    elif not films.missing(project, run, out, made_with):
        say("nothing to render")
        _list(project, out)
        return
    try:
        worker.run(
            f"{__name__}:render_in_blender",
            {
                "scene": str(project.path),
                "out": str(out.absolute()),
                "shots": [[shot.camera, shot.frame, shot.name] for shot in undone],
                "filmed": [list(pair) for pair in made_with],
            },
            Reporter(),
            eevee=project.render.engine == "eevee",
        )
    finally:
        part.sweep(out)
    _list(project, out)


def bench(arguments: argparse.Namespace) -> int:
    """Measure, print the tables, and say whether every target is met."""
    from . import bench
    from .bench import plots, table

    report = bench.measure(arguments.full, Reporter())
    text = json.dumps(report.as_json(), indent=1)
    if arguments.json:
        print(text)
    else:
        print(table.markdown(report) if arguments.markdown else table.page(report))
    if arguments.out:
        for path in plots.draw(report, arguments.out):
            say(f"wrote {path}")
        part = arguments.out / "bench.part.json"
        part.write_text(text + "\n", encoding="utf-8")
        part.replace(arguments.out / "bench.json")
    missed = sum(not target.met for target in report.targets)
    say(f"{len(report.targets) - missed} of {len(report.targets)} targets met")
    return 1 if missed else 0


def _list(project: Project, out: Path) -> None:
    """Name what there is, a line per folder of pictures and per film."""
    from .render import manifest

    files = manifest.load(out)["files"]
    folders: dict[str, int] = {}
    for name in files:
        if not name.endswith(".mp4"):
            kind = f"{Path(name).parent}/*{Path(name).suffix}"
            folders[kind] = folders.get(kind, 0) + 1
    for kind, number in folders.items():
        print(f"{out / kind}  {_count(number, 'picture')}")
    for name in files:
        if name.endswith(".mp4"):
            print(out / name)
    print(out / manifest.NAME)


def _count(number: int, noun: str) -> str:
    return f"{number:,} {noun}" + ("" if number == 1 else "s")


def _open(folder: Path) -> Run:
    from firetwin_core import run

    return run.open(folder)


def _load(scene: str | Path) -> tuple[Project, Run]:
    """Read the scene file and open its run; they must fit each other."""
    from . import check, project

    loaded = project.load(scene)
    run = _open(loaded.run)
    check.against_run(loaded, run)
    return loaded, run


# What follows runs in the worker process, where Blender is.


def build_in_blender(scene: str, out: str, progress: Progress) -> None:
    """Build the scene and save it under a temporary name that it then loses."""
    import bpy

    project, run = _load(scene)
    _built(project, run, progress)
    part = Path(out).with_suffix(".part.blend")
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(part), compress=True, relative_remap=False)
    part.replace(out)


def bake_in_blender(scene: str, progress: Progress) -> str:
    """Bake and return the folder of the volumes."""
    from .scene import bake

    project, run = _load(scene)
    return str(bake.bake(project, run, progress))


def render_in_blender(
    scene: str, out: str, shots: list[list[Any]], filmed: list[list[str]], progress: Progress
) -> None:
    """Render these shots, then make the films of these cameras and passes."""
    from .render import frames, passes, settings, video

    project, run = _load(scene)
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

    bpy.ops.wm.read_factory_settings(use_empty=True)
    if project.smoke.enabled and frames != []:
        bake.bake(project, run, progress, frames)
    progress(0, 1, "building the scene")
    scene = build.build(project, run)
    engine.apply(project, scene)
    progress(1, 1, "building the scene")
    return scene
