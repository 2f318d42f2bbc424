"""Pictures of a story's shots: maps, pictures of cameras, and wipes between two passes of a camera."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from firetwin_core.run import Run

from .. import files, output
from ..errors import input_error
from ..jobs import render, worker
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, count
from ..render.picture import Picture
from ..run import content, labels, readers
from ..shot.source import ShotSource
from . import timeline, wipe
from .quality import Quality, picture_of
from .scenes import FOLDER, Scenes
from .storyboard import MAP, SCENE, Storyboard
from .timeline import Span
from .words import Words

if TYPE_CHECKING:
    from .growth_map import Growth

_MAPS = 3  # version of the maps' drawing; others are drawn again


@dataclass(frozen=True)
class ShotPictures:
    """Pictures of the shots of a storyboard in a quality.

    Attributes
    ----------
    places
        File of named places; None: the places of the run's fire.
    overwrite
        Replace files that are not Firetwin's, and fit all cameras again.
    """

    story: Storyboard
    run: Run
    quality: Quality
    places: Path | None = None
    overwrite: bool = False
    _fitting: threading.Lock = field(default_factory=threading.Lock, init=False, repr=False, compare=False)
    """Lock for camera fits: they share caches."""

    @property
    def out(self) -> Path:
        """Folder of the story."""
        return self.story.path.parent.absolute()

    def make(
        self,
        spans: Sequence[Span],
        resume: bool,
        progress: Progress,
        tell: MessageCallback,
        stop: Stop | None = None,
    ) -> None:
        """Make the missing pictures of shots: maps, then scenes, several at a time, then wipes.

        Raises
        ------
        InputError
            A shot names an unknown place or camera, or a file cannot be written.
        StoppedError
            `stop` was used; finished pictures remain.
        """
        for span in (each for each in spans if each.shot.picture == MAP):
            self._draw_maps(span, resume, progress, tell, stop)
        rendered = [each for each in spans if each.shot.picture == SCENE and not each.shot.wipe_from]
        if rendered:
            self._render_all(rendered, resume, progress, tell, stop or Stop())
        for span in (each for each in spans if each.shot.wipe_from):
            left = next(each for each in spans if each.shot.name == span.shot.wipe_from)
            self._join(span, left)

    def make_shot(
        self, name: str, resume: bool, progress: Progress, tell: MessageCallback, stop: Stop | None = None
    ) -> Path:
        """Make the missing pictures of a shot and of its wipes, and return their folder.

        Raises
        ------
        InputError
            There is no such shot, or `make` would raise it.
        """
        spans = {span.shot.name: span for span in timeline.lay_out(self.story)}
        if name not in spans:
            raise input_error(self.story.path, f'has no shot "{name}"; choose one of its [[shots]]')
        of = spans[name].shot.wipe_from or name
        chosen = [span for span in spans.values() if of in (span.shot.name, span.shot.wipe_from)]
        self.make(chosen, resume, progress, tell, stop)
        return self.out / FOLDER / name

    def count(self, span: Span) -> int:
        """Count the pictures of a shot."""
        return self.quality.pictures(span, self.story.fps)

    def files(self, span: Span) -> list[Path]:
        """Return the files that the film shows; a wipe has a file for each frame of the film."""
        shot = span.shot
        if shot.wipe_from:
            return self._numbered(span, "wipe", span.length)
        return self._numbered(span, "map", self.count(span)) if shot.picture == MAP else self._rendered(span)

    def _numbered(self, span: Span, kind: str, pictures: int) -> list[Path]:
        name = span.shot.name
        folder = self.out / FOLDER / name / kind
        return [folder / f"{name}_{kind}_{number:06d}.png" for number in range(1, pictures + 1)]

    def _rendered(self, span: Span) -> list[Path]:
        """Return the rendered pictures of a shot; a wipe's are in the folder of the other shot."""
        shot = span.shot
        folder, numbers = self.out / FOLDER / (shot.wipe_from or shot.name), range(1, self.count(span) + 1)
        return [folder / Picture(shot.camera, each, shot.render_pass).file(".png") for each in numbers]

    def _render_all(
        self, spans: list[Span], resume: bool, progress: Progress, tell: MessageCallback, stop: Stop
    ) -> None:
        """Render the pictures of shots, `Quality.at_once` shots at a time."""
        shown = _Together(progress, tell, [self.count(span) for span in spans])
        worker.end_on_sigterm()
        at_once = min(self.quality.at_once, os.cpu_count() or 1)
        with ThreadPoolExecutor(at_once) as pool:
            tasks = [
                pool.submit(self._render, span, resume, partial(shown.progress, number), shown.tell, stop)
                for number, span in enumerate(spans)
            ]
            try:
                for task in as_completed(tasks):
                    task.result()
            except BaseException:
                for task in tasks:
                    task.cancel()
                stop.now()
                raise

    def _render(
        self, span: Span, resume: bool, progress: Progress, tell: MessageCallback, stop: Stop
    ) -> None:
        """Render the pictures of a shot, and of wipes to other passes of its camera."""
        shot = span.shot
        tell(f"shot {shot.name}: {count(self.count(span), 'picture')}")
        with self._fitting:
            self._scenes.write(span)
        asked = render.RenderRequest(
            self.out / FOLDER / shot.name,
            passes=",".join(self.story.passes_of(shot)),
            resume=resume,
            films=False,
        )
        render.run(ShotSource(scene=str(self._scenes.path(shot))), asked, progress, tell, stop)

    @cached_property
    def _scenes(self) -> Scenes:
        return Scenes(self.story, self.run, self.quality, self.overwrite)

    def _draw_maps(
        self, span: Span, resume: bool, progress: Progress, tell: MessageCallback, stop: Stop | None
    ) -> None:
        """Draw the maps of a shot, unless they exist and their inputs are the same."""
        paths, (start, end) = self.files(span), (span.shot.start, span.shot.end)
        assert start
        assert end
        tell(f"shot {span.shot.name}: {count(len(paths), 'picture')}")
        note = _Note(paths, self._map_inputs(span))
        if resume and note.is_true():
            return
        steps = max(len(paths) - 1, 1)
        drawn = [(path, start + (end - start) * (k / steps)) for k, path in enumerate(paths)]
        run, size = Path(self.run.path), self.quality.resolution
        words, overwrite = self.story.words, self.overwrite
        work = partial(draw_maps, run, self.places, self.story.zone, size, words, drawn, overwrite)
        worker.run(work, progress, stop=stop, tell=tell)
        note.write(self.overwrite)

    def _map_inputs(self, span: Span) -> list[Any]:
        """Return all inputs of a shot's maps."""
        return [
            _MAPS,
            str(span.shot.start),
            str(span.shot.end),
            self.quality.resolution,
            [each[:3] for each in labels.find(self.run, self.places)],
            self.story.zone,
            vars(self.story.words),
            content.inputs(self.run, self.out / "cache"),
        ]

    def _join(self, span: Span, other: Span) -> None:
        """Join the pictures of a shot with the pictures of another one, for each frame of the film."""
        left, right, paths = self._rendered(other), self._rendered(span), self.files(span)
        note = _Note(paths, [[each.stat().st_mtime_ns, each.stat().st_size] for each in (*left, *right)])
        if note.is_true():
            return
        shown = [picture_of(span, len(right), frame) - 1 for frame in range(span.first, span.end)]
        wipe.write([(path, left[k], right[k]) for path, k in zip(paths, shown, strict=True)], self.overwrite)
        note.write(self.overwrite)


class _Note:
    """Hash of the inputs of a shot's pictures, in their folder; pictures of an equal hash are up to date."""

    def __init__(self, paths: list[Path], inputs: list[Any]) -> None:
        text = json.dumps([len(paths), *inputs])
        self._content = {"sha256": hashlib.sha256(text.encode()).hexdigest()}
        self._path, self._paths = paths[0].with_name("made_from.json"), paths

    def is_true(self) -> bool:
        """Return whether the pictures exist and have these inputs."""
        with contextlib.suppress(OSError, ValueError):
            return files.read_json(self._path) == self._content and all(map(Path.is_file, self._paths))
        return False

    def write(self, overwrite: bool) -> None:
        """Write the note."""
        output.write_text(self._path, json.dumps(self._content), overwrite)


class _Together:
    """Progress and messages of several shots that are rendered at a time, by number of pictures."""

    def __init__(self, progress: Progress, tell: MessageCallback, pictures: list[int]) -> None:
        self._progress, self._tell, self._total = progress, tell, sum(pictures)
        self._done = [0] * len(pictures)
        self._pictures, self._lock = pictures, threading.Lock()

    def progress(self, number: int, done: int, total: int, what: str = "", note: str = "") -> None:
        """Report the progress of a shot; of its works, only rendering counts."""
        if what != "rendering":
            return
        with self._lock:
            self._done[number] = self._pictures[number] - total + done
            self._progress(sum(self._done), self._total, what, note)

    def tell(self, text: str) -> None:
        """Pass on a message."""
        with self._lock:
            self._tell(text)


def draw_maps(
    run: Path,
    places: Path | None,
    zone: str,
    size: tuple[int, int],
    words: Words,
    drawn: list[tuple[Path, datetime]],
    overwrite: bool,
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Draw maps of a run, each of a time; in a worker process, as letters need Blender."""
    import bpy  # noqa: F401 (its typeface)

    from .growth_map import Growth

    opened = readers.open(run)
    growth = Growth(opened, labels.find(opened, places), zone, size, words)
    for number, (path, moment) in enumerate(drawn, start=1):
        output.write(path, partial(_write_map, growth, moment), overwrite)
        progress(number, len(drawn), "drawing", path.name)


def _write_map(growth: Growth, moment: datetime, path: Path) -> None:
    from firetwin_core import sensor

    sensor.write_image(path, growth.draw(moment))
