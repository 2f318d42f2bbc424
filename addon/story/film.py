"""Film of a story: the pictures of its shots, the project of the Video Sequencer, and the film."""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from firetwin_core.run import Run

from .. import files, output
from ..errors import input_error, writing
from ..jobs import render, worker
from ..progress import MessageCallback, Progress, count
from ..render.picture import Picture
from ..run import content, labels, readers
from ..shot.source import ShotSource
from ..stations import events
from . import captions, timeline
from .captions import Caption
from .quality import Quality, picture_of
from .scenes import FOLDER, Scenes
from .storyboard import CARD, MAP, Storyboard
from .timeline import Span

if TYPE_CHECKING:
    from .growth_map import Growth
    from .sequencer import Project, Reel

BLEND, FILM = "story.blend", "story.mp4"
_MAPS = 1  # version of the maps' drawing; others are drawn again
_HELD = 1.0  # s; a picture that stays longer is moved over


@dataclass(frozen=True)
class Film:
    """Film of a storyboard in a quality.

    Attributes
    ----------
    places
        File of named places; None: the places of the run's fire.
    overwrite
        Replace a film that is not Firetwin's, and fit all cameras again.
    """

    story: Storyboard
    run: Run
    quality: Quality
    captions: list[Caption]
    places: Path | None = None
    overwrite: bool = False

    @property
    def out(self) -> Path:
        """Folder of the story."""
        return self.story.path.parent.absolute()

    def make(self, resume: bool, progress: Progress, tell: MessageCallback) -> list[Path]:
        """Render the pictures that are missing, lay out the project, and render its film.

        Returns
        -------
        The project and the film.

        Raises
        ------
        InputError
            A shot names an unknown place or camera, or a file cannot be written.
        """
        paths = [self.out / BLEND, self.out / FILM]
        output.check_blend(paths[0])
        output.check(paths[1], self.overwrite)
        spans = timeline.lay_out(self.story)
        for span in sorted(spans, key=lambda each: each.shot.picture != MAP):
            self._pictures(span, resume, progress, tell)
        tell(f"cutting {count(len(spans), 'shot')}")
        work = partial(cut, self._project(spans), self.overwrite)
        worker.run(work, progress, tell=tell)
        return paths

    def _pictures(self, span: Span, resume: bool, progress: Progress, tell: MessageCallback) -> None:
        """Render the pictures of a shot."""
        shot = span.shot
        if shot.picture == CARD:
            return
        tell(f"shot {shot.name}: {count(self._count(span), 'picture')}")
        if shot.picture == MAP:
            self._maps(span, resume, progress, tell)
            return
        scenes = Scenes(self.story, self.run, self.quality, self.overwrite)
        scenes.write(span)
        asked = render.RenderRequest(
            self.out / FOLDER / shot.name, passes=shot.render_pass, resume=resume, films=False
        )
        render.run(ShotSource(scene=str(scenes.path(shot))), asked, progress, tell)

    def _count(self, span: Span) -> int:
        return self.quality.pictures(span, self.story.fps)

    def _map_files(self, span: Span) -> list[Path]:
        """Return the files of a shot's maps."""
        name = span.shot.name
        folder = self.out / FOLDER / name / "map"
        return [folder / f"{name}_map_{number:06d}.png" for number in range(1, self._count(span) + 1)]

    def _maps(self, span: Span, resume: bool, progress: Progress, tell: MessageCallback) -> None:
        """Draw the maps of a shot, unless they exist and their inputs are the same."""
        paths, (start, end) = self._map_files(span), (span.shot.start, span.shot.end)
        assert start
        assert end
        note, made_from = paths[0].with_name("made_from.json"), {"sha256": self._map_digest(span)}
        with contextlib.suppress(OSError, ValueError):
            if resume and files.read_json(note) == made_from and all(path.is_file() for path in paths):
                return
        steps = max(len(paths) - 1, 1)
        drawn = [(path, start + (end - start) * (k / steps)) for k, path in enumerate(paths)]
        run, size = Path(self.run.path), self.quality.resolution
        work = partial(draw_maps, run, self.places, self.story.zone, size, drawn)
        worker.run(work, progress, tell=tell)
        files.write_text(note, json.dumps(made_from))

    def _map_digest(self, span: Span) -> str:
        """Return a hash of all inputs of a shot's maps."""
        names = [each[:3] for each in labels.find(self.run, self.places)]
        about = [_MAPS, str(span.shot.start), str(span.shot.end), self._count(span), self.quality.resolution]
        about += [names, self.story.zone, content.inputs(self.run, self.out / "cache")]
        return hashlib.sha256(json.dumps(about).encode()).hexdigest()

    def _project(self, spans: list[Span]) -> Project:
        """Describe the project."""
        from .sequencer import Project

        return Project(
            self.out / BLEND,
            tuple(self._reel(span) for span in spans),
            tuple(self.captions),
            tuple(self._markers(spans)),
            self.quality.resolution,
            self.story.fps,
            captions.SYNTHETIC if self.run.synthetic else "simulation",
        )

    def _reel(self, span: Span) -> Reel:
        """Describe the pictures of a shot; each frame of the film shows the nearest one."""
        from .sequencer import Reel

        shot, pictures = span.shot, self._count(span)
        if shot.picture == CARD:
            return Reel(span)
        if shot.picture == MAP:
            paths = [path.relative_to(self.out).as_posix() for path in self._map_files(span)]
        else:
            frames = range(1, pictures + 1)
            own = (Picture(shot.camera, number, shot.render_pass).file(".png") for number in frames)
            paths = [f"{FOLDER}/{shot.name}/{each}" for each in own]
        names = [Path(path).name for path in paths]
        shown = tuple(names[picture_of(span, pictures, k) - 1] for k in range(span.first, span.end))
        still = shot.picture != MAP and shot.seconds / pictures > _HELD
        return Reel(span, Path(paths[0]).parent.as_posix(), shown, still)

    def _markers(self, spans: list[Span]) -> Iterator[tuple[int, str]]:
        """Yield frame and text of events of the run that a map shows."""
        run = self.run
        happened = [*events.ignitions(run), *events.arrivals_at(run, labels.find(run, self.places))]
        for span in spans:
            yield span.first, span.shot.name
            for event in happened if span.shot.picture == MAP else ():
                if (frame := _frame_of(span, event.time)) is not None:
                    yield frame, event.words


def _frame_of(span: Span, moment: datetime) -> int | None:
    """Return the frame of the film at a model time; None if the shot does not show it."""
    shot = span.shot
    if shot.start is None or shot.end is None or not shot.start <= moment <= shot.end:
        return None
    return span.first + round((moment - shot.start) / (shot.end - shot.start) * (span.length - 1))


def draw_maps(
    run: Path,
    places: Path | None,
    zone: str,
    size: tuple[int, int],
    drawn: list[tuple[Path, datetime]],
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Draw maps of a run, each of a time; in a worker process, as letters need Blender."""
    import bpy  # noqa: F401 (its typeface)

    from .growth_map import Growth

    opened = readers.open(run)
    growth = Growth(opened, labels.find(opened, places), zone, size)
    for number, (path, moment) in enumerate(drawn, start=1):
        files.write(path, partial(_write_map, growth, moment), durable=False)
        progress(number, len(drawn), "drawing", path.name)


def _write_map(growth: Growth, moment: datetime, path: Path) -> None:
    from firetwin_core import sensor

    sensor.write_image(path, growth.draw(moment))


def cut(project: Project, overwrite: bool, progress: Progress, tell: MessageCallback) -> None:
    """Lay out the project in its file, and render its film; in a worker process."""
    import bpy

    from ..jobs import build
    from ..render import verify
    from . import sequencer

    if project.path.is_file():
        _open(project.path)
    else:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        sequencer.set_up(bpy.data.scenes[0])
    if sequencer.SCENE_NAME not in bpy.data.scenes:
        raise input_error(project.path, f"has no scene {sequencer.SCENE_NAME}; rename or delete the file")
    sequencer.lay_out(bpy.data.scenes[sequencer.SCENE_NAME], project)
    build.save(project.path, tell)
    film = project.path.with_name(FILM)
    progress(0, 1, "filming")

    def put(part: Path) -> None:
        _open(project.path)  # so that paths relative to it are valid
        bpy.data.scenes[sequencer.SCENE_NAME].render.filepath = str(part)
        with writing(film):
            bpy.ops.render.render(animation=True, scene=sequencer.SCENE_NAME)
        verify.film(part)

    output.write(film, put, overwrite)
    progress(1, 1, "filming")


def _open(path: Path) -> None:
    """Open a project.

    Raises
    ------
    InputError
        Blender cannot read it.
    """
    import bpy

    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise input_error(path, f"is not a Blender file: {' '.join(str(error).split())}; rename it") from None
