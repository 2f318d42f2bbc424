"""Follow job: renders the frames of a growing run as soon as the next model time exists.

Each frame is rendered from the run as it was known at the next model time (`known_run`), so that
it equals the frame that is rendered when the model has ended.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from .. import files
from ..errors import Error, UsageError
from ..jobs import render, worker
from ..jobs.render import RenderRequest, RenderResult
from ..progress import MessageCallback, Progress, count, duration, no_message, silent
from ..run import content, readers, times
from ..shot import frames
from ..shot.frames import Frames
from ..shot.light import exposure
from ..shot.schema.frame_list import FrameList
from ..shot.settings import Settings
from ..shot.source import ShotSource
from . import known_run, watched

Wait = Callable[[float], None]
_LATE = 60.0  # s without a sign of `firetwin watch`, after which that is reported


@dataclass(frozen=True)
class _Poll:
    """A growing run at a poll: its newest revision, whether times follow, and the identity of its film."""

    run: Run
    ended: bool
    identity: str


def run(
    choice: ShotSource,
    asked: RenderRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    every: float = 5.0,
    wait: Wait = time.sleep,
) -> RenderResult:
    """Render frames while the run grows; return when all are rendered, or no times follow.

    Parameters
    ----------
    every
        Time between looks at the run, s.

    Raises
    ------
    UsageError
        The scene depends on later times, or has no end.
    InputError, Error
        As `render.run`.
    """
    settings = choice.settings()
    _check(settings)
    settings.cache.mkdir(parents=True, exist_ok=True)
    said = ""
    with (
        tempfile.TemporaryDirectory(prefix="follow-", dir=settings.cache) as folder,
        worker.Worker(eevee=settings.render.engine == "eevee") as process,
    ):
        film = _Film(choice, asked, Path(folder), process, progress, tell, stop)
        while True:
            poll, text = _look(settings, Path(folder)), f"waiting for the first time in {settings.run}"
            if poll is not None:
                groups, missing = _groups(settings, asked, poll)
                film.render(poll, groups)
                text = _describe_missing(poll, missing) if missing else ""
            text = "\n".join(each for each in (text, _describe_silence(settings.run)) if each)
            if text != said:
                for line in text.split("\n"):
                    tell(line)
                said = text
            if poll is not None and (poll.ended or not missing):
                return RenderResult(film.pictures, film.expected, film.peak)
            wait(every)


def _check(settings: Settings) -> None:
    """Check that a frame depends on no time after the next one.

    Raises
    ------
    UsageError
        It does.
    """
    if settings.time.resolved().end is None and settings.time.frames > 1:
        raise UsageError("--follow: the end of the run is not known; set time.end in the scene file")
    if settings.runs:
        raise UsageError("--follow: films one run; remove [[runs]]")
    for camera in settings.cameras:
        if camera.rig.follows_fire():
            raise UsageError(
                f'--follow: camera "{camera.name}" follows the fire, whose later places are not known; '
                "give it a target by latitude and longitude"
            )


def _look(settings: Settings, place: Path) -> _Poll | None:
    """Open the newest revision, linked into the folder `place`; None before the first time."""
    folder = settings.run
    if not watched.is_watched(folder):
        run = readers.open(folder)
        return _Poll(run, True, content.fingerprint({"run": content.inputs(run, settings.cache)}))
    ended = watched.is_final(folder)  # before the times, which may follow
    accepted = watched.times(folder)
    if not accepted:
        if ended:
            raise Error(f"{folder}: the model ended without a complete time")
        return None
    first = watched.last_generation(accepted)[0]
    kept = _keep(folder, place / "revisions")
    return _Poll(readers.open(kept), ended, f"{first.generation} {first.time} {first.sha256}")


def _keep(folder: Path, place: Path) -> Path:
    """Link the newest revision into a folder, as `firetwin watch` removes old ones; return its copy."""
    while True:
        newest = watched.newest(folder)
        assert newest is not None
        kept = place / newest.parent.name / newest.name
        if kept.is_dir():
            return kept
        shutil.rmtree(place, ignore_errors=True)
        try:
            return Path(shutil.copytree(newest, kept, copy_function=files.link_or_copy))
        except OSError:
            if watched.newest(folder) == newest:
                raise


def _groups(settings: Settings, asked: RenderRequest, poll: _Poll) -> tuple[dict[int, list[int]], int]:
    """Group the requested frames by the number of times that they need; also count those that must wait."""
    shown = _frames(settings, poll.run)
    try:
        wanted = FrameList(asked.frames or "").frames(shown.count)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    known_times = np.asarray(poll.run.times)
    groups: dict[int, list[int]] = {}
    for frame in wanted:
        needed = known_run.next_time(known_times, shown.time(frame), poll.ended)
        groups.setdefault(needed, []).append(frame)
    return groups, len(groups.pop(0, []))


class _Film:
    """Films the groups of frames of one request; each group is rendered once, all in one process."""

    def __init__(
        self,
        choice: ShotSource,
        asked: RenderRequest,
        folder: Path,
        process: worker.Worker,
        progress: Progress,
        tell: MessageCallback,
        stop: worker.Stop | None,
    ) -> None:
        self.choice, self.asked, self.folder, self.process = choice, asked, folder, process
        self.progress, self.tell, self.stop = progress, tell, stop
        self.settings = choice.settings()
        self.identity, self.exposure = "", ""
        self.rendered: set[int] = set()
        self.pictures = self.expected = self.peak = 0

    def render(self, poll: _Poll, groups: dict[int, list[int]]) -> None:
        """Render the groups of a revision that are not rendered yet."""
        if poll.identity != self.identity:
            if self.identity:
                self.tell("the model started again; all frames are rendered from its new times")
            self.identity, self.exposure = poll.identity, ""
            self.rendered.clear()
        for needed, listed in sorted(groups.items()):
            todo = [frame for frame in listed if frame not in self.rendered]
            if todo:
                self._render(poll, needed, todo)
                self.rendered.update(todo)

    def _render(self, poll: _Poll, needed: int, listed: list[int]) -> None:
        shutil.rmtree(self.folder / "known", ignore_errors=True)
        place = self.folder / "known" / str(needed) / self.settings.run.absolute().name
        end = _frames(self.settings, poll.run).last
        known_run.write(poll.run, needed, end, place, poll.identity)
        choice = replace(self.choice, run=str(place), cache=str(self._cache()))
        if self.settings.light.exposure is None:
            self.exposure = self.exposure or self._meter(choice)
            choice = replace(choice, exposure=self.exposure)
        asked = replace(self.asked, frames=",".join(map(str, listed)), resume=True)
        made = render.run(choice, asked, self.progress, self.tell, self.stop, process=self.process)
        self.pictures += made.pictures
        self.expected, self.peak = max(self.expected, made.expected), max(self.peak, made.peak)

    def _cache(self) -> Path:
        """Return the cache, without the smoke of earlier known runs, which no other render can use.

        Selected tiles stay in the cache of the scene file.
        """
        if self.settings.tiles.sources:
            return self.settings.cache.absolute()
        place = self.folder / "cache"
        shutil.rmtree(place, ignore_errors=True)
        return place

    def _meter(self, choice: ShotSource) -> str:
        """Meter the first frame; later frames keep this exposure, as later light is not known."""
        shot = choice.shot()
        stops = round(float(exposure.at(shot, np.array([1.0]))[0]), 3)
        self.tell(f"exposure is fixed at {stops:g} stops, as metered in frame 1; light.exposure sets it")
        return repr(stops)


def _frames(settings: Settings, run: Run) -> Frames:
    found = frames.resolve(settings.time, run)
    if found.first < run.times[0]:
        raise UsageError("--follow: time.start is before the first time of the run; change it")
    return found


def _describe_missing(poll: _Poll, missing: int) -> str:
    """Describe the frames that wait, or that the run does not reach."""
    newest = times.iso(times.utc(poll.run, float(poll.run.times[-1])))
    if poll.ended:
        return f"the run ended at {newest}, before the film: {count(missing, 'frame')} not rendered"
    return f"rendered up to {newest}; {count(missing, 'frame')} left, until the next model time exists"


def _describe_silence(folder: Path) -> str:
    """Return a warning if `firetwin watch` seems to have stopped; "" otherwise."""
    status = watched.status(folder)
    try:
        age = time.time() - datetime.fromisoformat(status["updated"]).timestamp()
        late = max(_LATE, 5.0 * float(status["every"]))
    except (KeyError, TypeError, ValueError):
        return ""
    if status.get("state") in watched.FINAL or age < late:
        return ""
    return (
        f"firetwin watch has not written to {folder} for {duration(age)}; if it has stopped, start it again"
    )
