"""Render what is asked for and not finished, then the films."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import memory
from ..errors import Error
from ..progress import READING, MessageCallback, Progress, count, no_message, notify_if_slow, share, silent
from ..shot.comparison import for_view
from ..shot.shot import Shot
from ..shot.source import ShotSource
from . import solve, worker


@dataclass(frozen=True)
class RenderRequest:
    """What a render shall make (see `render.plan.pictures`); `resume` keeps what is finished and matches."""

    out: Path
    frames: str | None = None
    camera: str | None = None
    passes: str | None = None
    resume: bool = False


@dataclass(frozen=True)
class RenderResult:
    """How many pictures a render made, and bytes of memory: the most that was expected, and the peak.

    0 where nothing was rendered, or nobody knows.
    """

    pictures: int
    expected: int = 0
    peak: int = 0


def run(
    choice: ShotSource,
    asked: RenderRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> RenderResult:
    """Render what is asked for and not finished, then the films."""
    from ..errors import UsageError
    from ..render import dataset, films, fingerprint, plan
    from ..render.store import Store
    from ..run.readers import folder

    out = asked.out
    if folder.sniff(out):  # a camera's folder may have the name of a field
        raise UsageError(
            f"--out: {out} is a run folder, and pictures do not belong among its fields; choose another"
        )
    with notify_if_slow(READING):
        shot = choice.shot()
        wanted = plan.pictures(shot, asked.frames, asked.camera, asked.passes)
    made_with = fingerprint.of_pictures(shot, wanted, progress)
    with Store(out) as store:
        undone = plan.missing(store, wanted, made_with)
        finished = len(wanted) - len(undone)
        before = 0 if asked.resume else store.number()
        if not undone and asked.resume and not any(films.missing(shot, store, made_with)):
            tell(f"{finished} of {count(len(wanted), 'picture')} are finished and match; nothing to render")
            store.export()
            return RenderResult(0)
    if asked.resume and finished:
        tell(f"{finished} of {count(len(wanted), 'picture')} are finished and match")
    elif finished:
        tell(f"rendering {count(finished, 'picture')} again that match; --resume would keep them")
    undone = undone if asked.resume else wanted
    if undone:
        cameras = " and ".join(dict.fromkeys(picture.camera for picture in undone))
        tell(f"rendering {count(len(undone), 'picture')} of {cameras}")
    task = {"choice": choice.plain(), "filmed": [list(pair) for pair in made_with], "after": before}
    with Store(out, create=True) as store:
        took = make(f"{__name__}:in_blender", task, undone, store, shot, progress, tell, stop)
        dataset.write(store)
    return RenderResult(len(undone), **took)


def make(
    job: str,
    task: dict[str, Any],
    undone: list[Any],
    store: Any,
    shot: Shot,
    progress: Progress,
    tell: MessageCallback,
    stop: worker.Stop | None,
) -> Any:
    """Have a process make pictures; whatever ends it, no others wait for its own and the manifest is written.

    Parameters
    ----------
    task
        What the job takes besides `out`, `pictures` and `owner`.

    Returns
    -------
    What the job returns.
    """
    from .. import leases

    owner = leases.new_owner()
    pictures = [[picture.camera, picture.frame, picture.name] for picture in undone]
    task = task | {"out": str(store.out.absolute()), "pictures": pictures, "owner": owner}
    eevee = shot.settings.render.engine == "eevee"
    follow = following(store.out, progress, tell)
    try:
        found = worker.run(job, task, follow, eevee=eevee, stop=stop, tell=tell)
    except BaseException:
        with contextlib.suppress(Error):  # what stopped the work is what to tell
            leases.leave(store.data, owner)
            store.export()
        raise
    leases.leave(store.data, owner)
    store.export()
    return found


def following(out: Path, progress: Progress, tell: MessageCallback) -> Progress:
    """Progress whose note names a picture in the folder `out`: it shows the path, and tells of the first."""
    told = False

    def follow(done: int, total: int, what: str = "", note: str = "") -> None:
        nonlocal told
        if note and done < total and not told:
            told = True
            tell(f"the first picture is there: {out / note}; the film goes on")
        progress(done, total, what, f"last: {out / note}" if note else "")

    return follow


def in_blender(
    choice: dict[str, str],
    out: str,
    pictures: list[list[Any]],
    filmed: list[list[str]],
    owner: str,
    after: int,
    progress: Progress,
    tell: MessageCallback,
) -> dict[str, int]:
    """Render these pictures, each camera in a scene of its own, then films of these cameras and passes.

    Pictures that other renders make at the same time are left to them.

    Returns
    -------
    Bytes of memory, `expected` and `peak`, as of `Made`.
    """
    from ..render import comparison, fingerprint, plan, sharing, video
    from ..render.picture import Picture
    from ..shot import passes
    from ..smoke import plume_mass

    shot = ShotSource(**choice).shot()
    asked = [Picture(*picture) for picture in pictures]
    todo = [picture for picture in asked if not passes.compares(picture.name)]
    drawn = set(todo)
    if todo:
        _check_device(shot)
    frames, expected = frames_of(todo), 0
    made_with = fingerprint.of_pairs(shot, {(camera, name) for camera, name in filmed}, progress)
    with sharing.open_session(Path(out), made_with, owner, after) as making:
        over = 0
        for part in plan.rounds(shot, todo):
            over += frames_of(part)
            while free := making.free(part, tell):
                done = over - frames_of(free)
                for camera, group in itertools.groupby(free, key=lambda picture: picture.camera):
                    wanted = list(group)
                    own = share(progress, done, frames, "rendering")
                    expected = max(
                        expected,
                        _camera(ShotSource(**choice), for_view(shot, camera), making, wanted, own, tell),
                    )
                    done += frames_of(wanted)
        if todo and shot.settings.smoke.enabled:
            tell(plume_mass.describe(shot))
        comparison.make(shot, making, [each for each in asked if each not in drawn], progress, tell)
        video.make(shot, making, progress)
    return {"expected": expected, "peak": memory.peak()}


def _check_device(shot: Shot) -> None:
    """Find out before anything is built whether there is what Cycles shall render on."""
    import bpy

    from ..blender import devices
    from ..errors import Error
    from ..shot.settings import scene_file

    render, path = shot.settings.render, shot.settings.path
    if render.engine != "cycles":
        return
    try:
        devices.take(render.device, bpy.context.scene)
    except Error as error:
        if path.is_file():
            raise scene_file.error_at(path, ("render", "device"), str(error)) from None
        raise


def frames_of(pictures: list[Any]) -> int:
    """How many frames pictures are of."""
    return len({(picture.camera, picture.frame) for picture in pictures})


def _camera(
    choice: ShotSource, shot: Shot, making: Any, wanted: list[Any], progress: Progress, tell: MessageCallback
) -> int:
    """Render the pictures of a shot's one camera; its smoke is made a frame ahead of them.

    Returns the bytes of memory that were expected for it.
    """
    from ..blender import devices
    from ..render import memory_estimate as expected
    from ..render import pictures, plan
    from ..smoke import prefetch
    from . import worker_scene

    for text in shot.warnings():
        tell(text)
    frames, done, most = frames_of(wanted), 0, 0
    drawn, hazy = plan.rendered(shot, wanted), smoky(shot, wanted)
    with (
        _solving(choice, shot, hazy, progress) as elsewhere,
        prefetch.smoke(shot, hazy, progress, tell, elsewhere) as ready,
    ):
        for part, group in _parts(shot, wanted):
            stage = worker_scene.build_scene(part, progress, tell) if drawn else worker_scene.empty()
            if drawn and shot.settings.render.engine == "cycles" and not done:
                tell(f"Cycles renders on {devices.take(shot.settings.render.device, stage.scene)}")
            load = expected.load(shot, stage, hazy) if drawn else None
            if load and load.bytes > most:
                most = load.bytes
                tell(expected.describe(load))
            own = share(progress, done, frames, "rendering")
            pictures.render(shot, stage, making, group, own, ready, tell)
            done += frames_of(group)
    return most


@contextlib.contextmanager
def _solving(
    choice: ShotSource, shot: Shot, frames: list[int], progress: Progress
) -> Iterator[solve.Working | None]:
    """Have the smoke of a shot's one camera prepared meanwhile, unless it is."""
    from ..smoke import sources

    (camera,) = shot.settings.cameras
    source = sources.select(shot)
    marched = sources.is_integrated(shot)
    missing = [frame for frame in frames if not source.is_prepared(frame)] if marched else []
    if not missing:
        yield None
        return

    def told(*done: Any) -> None:
        """Tell of it until the first picture can be drawn."""
        if not source.is_prepared(missing[0]):
            progress(*done)

    with solve.beside(choice, camera.name, missing, told) as working:
        yield working


def _parts(shot: Shot, wanted: list[Any]) -> Iterator[tuple[Shot, list[Any]]]:
    """What is built at a time, `render.chunk` frames of the camera, with the pictures of these frames.

    Which frames are built together does not hang on which of them are wanted.
    """
    from ..shot import frames

    (camera,) = shot.settings.cameras
    chunk = shot.settings.render.chunk
    own = frames.parts(shot.frames_of(camera), chunk)
    for k, group in itertools.groupby(wanted, lambda picture: frames.part_of(picture.frame, chunk)):
        yield shot if len(own) == 1 else shot.for_frames(own[k]), list(group)


def smoky(shot: Shot, wanted: list[Any]) -> list[int]:
    """Frames of pictures that show smoke, ascending."""
    from ..render import plan
    from ..shot import passes

    if not shot.settings.smoke.enabled:
        return []
    known = passes.known()
    smoky = {
        name
        for name in {picture.name for picture in wanted}
        if any(
            "smoke" in known[each].aspects
            for _, each in plan.rendered(shot, [p for p in wanted if p.name == name])
        )
    }
    return sorted({picture.frame for picture in wanted if picture.name in smoky})
