"""Render job: renders the requested pictures that are not finished, then the films."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from .. import memory
from ..errors import Error
from ..progress import READING, MessageCallback, Progress, count, no_message, notify_if_slow, share, silent
from ..shot.comparison import for_view
from ..shot.shot import Shot
from ..shot.source import ShotSource
from ..shot.tiles import tile_terms
from . import first_picture, solve, worker
from .tiles import imagery, selection
from .tiles.access import TileAccess

if TYPE_CHECKING:
    from ..blender.devices import Gpus
    from ..blender.owned import Stage
    from ..render.fingerprint import Fingerprints
    from ..render.picture import Picture
    from ..render.sharing import RenderSession
    from ..render.store import Store

Result = TypeVar("Result")
Selection = tuple[str | None, str | tuple[str, ...] | None, str | None]
"""Frames, camera and passes, as `render.plan.pictures` takes them."""


@dataclass(frozen=True)
class RenderRequest:
    """A render request (see `render.plan.pictures`).

    Attributes
    ----------
    camera
        One, or several that one process renders.
    resume
        Keep finished pictures with equal settings.
    films
        Make films of the pictures.
    access
        Access to tiles.
    coarse_first
        Write a coarse first picture while the flow of smoke is solved, unless pictures are resumed.
    """

    out: Path
    frames: str | None = None
    camera: str | tuple[str, ...] | None = None
    passes: str | None = None
    resume: bool = False
    films: bool = True
    access: TileAccess | None = None
    coarse_first: bool = False

    def selection(self) -> Selection:
        """Return the requested frames, cameras and passes."""
        return (self.frames, self.camera, self.passes)


@dataclass(frozen=True)
class RenderResult:
    """Number of pictures made by this render, and its peak memory in bytes, estimated and measured.

    0 if nothing was rendered, or the value is unknown.
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
    shot: Shot | None = None,
    process: worker.Worker | None = None,
) -> RenderResult:
    """Render the requested pictures that are not finished, then the films.

    Parameters
    ----------
    shot
        Shot of `choice`, if already resolved.
    process
        Process to render in; None: a new one.

    Raises
    ------
    InputError
        The output folder has files of others in its camera folders.
    """
    from ..render import dataset, fingerprint, plan
    from ..render.store import Store, refuse_others

    out = asked.out
    _refuse_run(out)
    with notify_if_slow(READING):
        shot = shot or choice.shot()
        wanted = plan.pictures(shot, *asked.selection())
    prepare_tiles(choice, wanted, asked, progress, tell, stop)  # fingerprints include the selection
    made_with = fingerprint.compute(shot, wanted, progress)
    refuse_others(out, dict.fromkeys(picture.camera for picture in wanted))
    with Store(out) as store:
        begun = store.latest_number()
        undone, filming = _compare(store, shot, wanted, made_with, asked, tell)
        if not undone and not filming:
            store.export()
            return RenderResult(0)
    if undone:
        views = list(dict.fromkeys(picture.camera for picture in undone))
        tell(f"rendering {count(len(undone), 'picture')} of {' and '.join(views)}")
        if asked.films:
            tell(shot.describe_film())
        imagery.prepare(choice, views, progress, tell, stop, asked.access)
    job = partial(in_blender, choice, replace(asked, out=out.absolute()), set(made_with), begun)
    with Store(out, create=True) as store:
        result = make(job, undone, store, shot, progress, tell, stop, process)
        dataset.write(store)
    if others := len(undone) - result.pictures:
        tell(f"another render made {others} of these {count(len(undone), 'picture')}")
    return result


def _refuse_run(out: Path) -> None:
    """Check that an output folder is not a run.

    Raises
    ------
    UsageError
        The folder is a run.
    """
    from ..errors import UsageError
    from ..run.readers import folder

    if folder.sniff(out):  # a camera's folder may have the name of a field
        raise UsageError(
            f"--out: {out} is a run folder, and pictures do not belong among its fields; choose another"
        )


def _compare(
    store: Store,
    shot: Shot,
    wanted: list[Picture],
    made_with: Fingerprints,
    asked: RenderRequest,
    tell: MessageCallback,
) -> tuple[list[Picture], list[tuple[str, list[str]]]]:
    """Compare the finished pictures and films with the request, and describe the differences.

    Returns
    -------
    Pictures to render, and films to encode if no picture is rendered: path, and reasons.
    """
    from ..render import changes, exr_clock, films, plan

    undone = plan.missing(store, wanted, made_with)
    finished = f"{len(wanted) - len(undone)} of {count(len(wanted), 'picture')} are finished and match"
    if asked.resume and (text := exr_clock.update(shot, store, set(wanted) - set(undone), made_with)):
        tell(text)
    differing = changes.of_pictures(store, undone, made_with) if asked.resume else []
    if asked.films and (kept := films.left_over(shot, store, made_with)):
        tell(f"films of other settings: {' and '.join(kept)}; delete them if you do not need them")
    filming = films.changes_of(shot, store, made_with) if asked.films and not undone else []
    if not asked.resume:
        if again := len(wanted) - len(undone):
            tell(f"rendering {count(again, 'picture')} again that match; --resume would keep them")
        return wanted, filming
    if not undone and not filming:
        tell(f"{finished}; nothing to render")
    elif len(undone) < len(wanted):
        tell(finished)
    if differing:
        tell(f"finished pictures are rendered again: {changes.join_names(differing)}")
    if filming:
        tell(changes.describe_films(filming))
    return undone, filming


def prepare_tiles(
    choice: ShotSource,
    wanted: list[Picture],
    asked: RenderRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> None:
    """Check the tile policies for the pictures' passes; prepare the tiles of their views.

    A resumed render keeps its tiles.
    """
    views = list(dict.fromkeys(picture.camera for picture in wanted))
    uses = tile_terms.of_passes(picture.name for picture in wanted)
    selection.prepare(choice, views, progress, tell, stop, asked.access, uses, keep=asked.resume)


def make(
    job: Callable[..., Result],
    undone: list[Picture],
    store: Store,
    shot: Shot,
    progress: Progress,
    tell: MessageCallback,
    stop: worker.Stop | None,
    process: worker.Worker | None = None,
) -> Result:
    """Run a render job in a worker process; then release its leases and write the manifest.

    Parameters
    ----------
    job
        Function for the worker, whose other arguments are `pictures` and `owner`.
    """
    from .. import leases

    owner = leases.new_owner()
    work = partial(job, pictures=undone, owner=owner)
    eevee = shot.settings.render.engine == "eevee"
    follow = picture_progress(store.out, progress, tell)
    try:
        if process is not None:
            result = process.run(work, follow, stop, tell)
        else:
            result = worker.run(work, follow, eevee=eevee, stop=stop, tell=tell)
    except BaseException:
        with contextlib.suppress(Error):  # the first error is the one to report
            leases.leave(store.data, owner)
            store.export()
        raise
    finally:
        first_picture.remove(store.out)
    leases.leave(store.data, owner)
    store.export()
    return result


def picture_progress(out: Path, progress: Progress, tell: MessageCallback) -> Progress:
    """Wrap a progress whose note is a picture in `out`: show its path, and report the first picture."""
    told = False

    def follow(done: int, total: int, what: str = "", note: str = "") -> None:
        nonlocal told
        if note and not told:
            told = True
            first_picture.remove(out)
            if done < total:
                tell(f"first picture: {out / note}; rendering continues")
        progress(done, total, what, f"last: {out / note}" if note else "")

    return follow


def in_blender(
    choice: ShotSource,
    asked: RenderRequest,
    filmed: set[tuple[str, str]],
    begun: int,
    pictures: list[Picture],
    owner: str,
    progress: Progress,
    tell: MessageCallback,
) -> RenderResult:
    """Render these pictures, each camera in a separate scene, then films of these cameras and passes.

    Pictures leased by other renders are skipped.

    Parameters
    ----------
    filmed
        Cameras and passes.
    begun
        Number of the store's latest entry when the render began; with `resume`, earlier entries are finished.
    """
    from ..render import comparison, fingerprint, plan, sharing, video
    from ..shot import passes
    from ..smoke import plume_mass
    from . import device

    shot = choice.shot()
    todo = [picture for picture in pictures if not passes.compares(picture.name)]
    drawn = set(todo)
    frames, expected, gpus = count_frames(todo), 0, None
    if todo and shot.settings.render.engine == "cycles":
        gpus = device.select(shot.settings, frames, tell)
    made_with = fingerprint.compute_pairs(shot, filmed, progress)
    everything, after = plan.pictures(shot, *asked.selection()), 0 if asked.resume else begun
    with sharing.open_session(asked.out, made_with, owner, after, begun, everything) as session:
        over = 0
        for part in plan.rounds(shot, todo):
            over += count_frames(part)
            while free := session.free(part, tell):
                done = over - count_frames(free)
                for camera, group in itertools.groupby(free, key=lambda picture: picture.camera):
                    wanted = list(group)
                    own = share(progress, done, frames, "rendering")
                    view = for_view(shot, camera)
                    coarse = asked.coarse_first and not (asked.resume and begun) and not session.finished
                    peak = _camera(choice, view, session, wanted, gpus, own, tell, coarse)
                    expected = max(expected, peak)
                    done += count_frames(wanted)
        if todo and shot.settings.smoke.enabled:
            tell(plume_mass.describe(shot))
        comparison.make(shot, session, [each for each in pictures if each not in drawn], progress, tell)
        if asked.films:
            video.make(shot, session, progress)
        made = len(session.finished)
    return RenderResult(made, expected, memory.peak())


def count_frames(pictures: list[Picture]) -> int:
    """Count the frames of these pictures."""
    return len({(picture.camera, picture.frame) for picture in pictures})


def _camera(
    choice: ShotSource,
    shot: Shot,
    session: RenderSession,
    wanted: list[Picture],
    gpus: Gpus | None,
    progress: Progress,
    tell: MessageCallback,
    coarse_first: bool = False,
) -> int:
    """Render the pictures of a shot's only camera; its smoke is prefetched one frame ahead.

    Cycles renders with `gpus`, or on the processor (None). With `coarse_first`, a coarse picture is written
    if a long solution of the smoke precedes the first picture.

    Returns the estimated peak memory, bytes.
    """
    from ..blender import devices
    from ..render import memory_estimate as expected
    from ..render import pictures, plan
    from ..shot.tiles import tile_cut
    from ..smoke import cache, prefetch
    from . import worker_scene

    for text in shot.warnings():
        tell(text)
    (camera,) = shot.settings.cameras
    frames, done, most = count_frames(wanted), 0, 0
    drawn, hazy = plan.rendered(shot, wanted), smoke_frames(shot, wanted)
    tiled = [tile_cut.location(shot)] if shot.settings.tiles.sources else []
    with (
        cache.in_use(*tiled),
        _solving(choice, shot, hazy, progress, tell) as elsewhere,
        prefetch.smoke(shot, hazy, progress, tell, elsewhere) as ready,
    ):
        for part, group in split_in_chunks(shot, wanted):
            stage = worker_scene.build_scene(part, progress, tell) if drawn else worker_scene.empty()
            if drawn and shot.settings.render.engine == "cycles":
                devices.use(gpus, stage.scene)
            load = expected.load(shot, stage, hazy, {name for _, name in drawn}) if drawn else None
            if load and load.bytes > most:
                most = load.bytes
                tell(expected.describe(load))
            own = share(progress, done, frames, "rendering")
            prepared = _with_culling(shot, stage, ready) if drawn else ready
            if coarse_first and elsewhere and done == 0 and (camera.name, "rgb") in drawn:
                _write_coarse(shot, stage, group[0].frame, session.store.out, tell)
            pictures.render(shot, stage, session, group, own, prepared, tell)
            done += count_frames(group)
    return most


def _write_coarse(shot: Shot, stage: Stage, frame: int, out: Path, tell: MessageCallback) -> None:
    """Write a coarse first picture if a long solution of smoke precedes the first one."""
    from ..scene.forest.frame_culling import FrameCulling

    if not first_picture.is_worthwhile(shot, frame):
        return
    FrameCulling(shot, stage).apply(frame)
    with contextlib.suppress(Error):  # which the film does not meet, or reports itself
        if path := first_picture.write(shot, stage, frame, out):
            tell(f"coarse first picture, until smoke is solved: {path}")


def _with_culling(shot: Shot, stage: Stage, ready: Callable[..., Any]) -> Callable[..., Any]:
    """Extend `ready` by culling the forest for its frame."""
    from ..scene.forest.frame_culling import FrameCulling

    culling = FrameCulling(shot, stage)

    def ready_and_culled(frame: int, ahead: list[int]) -> Any:
        culling.apply(frame)
        return ready(frame, ahead)

    return ready_and_culled


@contextlib.contextmanager
def _solving(
    choice: ShotSource, shot: Shot, frames: list[int], progress: Progress, tell: MessageCallback
) -> Iterator[solve.Working | None]:
    """Solve missing smoke of a shot's only camera in a concurrent process; first describe its cost."""
    from ..smoke import sources

    (camera,) = shot.settings.cameras
    source = sources.select(shot)
    marched = sources.is_integrated(shot)
    missing = [frame for frame in frames if not source.is_prepared(frame)] if marched else []
    if not missing:
        yield None
        return
    if cost := source.cost():
        tell(cost.describe())

    def report(*done: Any) -> None:
        """Report the solver's progress until the first picture can be drawn."""
        if not source.is_prepared(missing[0]):
            progress(*done)

    with solve.in_parallel(choice, camera.name, missing, report) as working:
        yield working


def split_in_chunks(shot: Shot, wanted: list[Picture]) -> Iterator[tuple[Shot, list[Picture]]]:
    """Split into chunks: shots of `render.chunk` frames of the camera, built together, with their pictures.

    Chunk boundaries do not depend on the requested frames.
    """
    from ..shot import frames

    (camera,) = shot.settings.cameras
    chunk = shot.settings.render.chunk
    own = frames.parts(shot.frames_of(camera), chunk)
    for k, group in itertools.groupby(wanted, lambda picture: frames.part_of(picture.frame, chunk)):
        yield shot if len(own) == 1 else shot.for_frames(own[k]), list(group)


def smoke_frames(shot: Shot, wanted: list[Picture]) -> list[int]:
    """List the frames of pictures that show smoke, ascending."""
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
