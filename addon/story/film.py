"""Film of a story: the pictures of its shots, the project of the Video Sequencer, and the film."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .. import output, timecode
from ..cuts import interchange
from ..errors import input_error, writing
from ..jobs import worker
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, count
from ..run import labels
from ..shot import passes
from ..stations import events
from . import timeline
from .captions import Caption
from .pictures import ShotPictures
from .quality import picture_of
from .storyboard import CARD, MAP
from .timeline import Span

if TYPE_CHECKING:
    from .sequencer import Project, Reel

BLEND, FILM, CUT = "story.blend", "story.mp4", "story"
_HELD = 1.0  # s; a picture that stays longer is moved over


@dataclass(frozen=True)
class Film:
    """Film of a storyboard: the pictures of its shots, and its captions."""

    pictures: ShotPictures
    captions: list[Caption]

    def make(
        self, resume: bool, progress: Progress, tell: MessageCallback, stop: Stop | None = None
    ) -> list[Path]:
        """Render the pictures that are missing, lay out the project, and render its film.

        Returns
        -------
        The project, the film, and its cut for other programs.

        Raises
        ------
        InputError
            A shot names an unknown place or camera, or a file cannot be written.
        """
        out, overwrite = self.pictures.out, self.pictures.overwrite
        paths = [out / BLEND, out / FILM]
        output.check_blend(paths[0])
        output.check(paths[1], overwrite)
        interchange.check(out, CUT, overwrite)
        spans = timeline.lay_out(self.pictures.story)
        self.pictures.make(spans, resume, progress, tell, stop)
        tell(f"cutting {count(len(spans), 'shot')}")
        work = partial(cut, self._project(spans), overwrite)
        return paths + worker.run(work, progress, stop=stop, tell=tell)

    def _project(self, spans: list[Span]) -> Project:
        """Describe the project."""
        from .sequencer import Project

        pictures = self.pictures
        return Project(
            pictures.out / BLEND,
            tuple(self._reel(span) for span in spans),
            tuple(each for each in self.captions if passes.known()[each.span.shot.render_pass].captions),
            tuple(self._markers(spans)),
            pictures.quality.resolution,
            pictures.story.fps,
            pictures.story.words.mark(pictures.run.synthetic),
        )

    def _reel(self, span: Span) -> Reel:
        """Describe the pictures of a shot; each frame of the film shows the nearest one."""
        from .sequencer import Reel

        if span.shot.picture == CARD:
            return Reel(span)
        paths = self.pictures.files(span)
        shown = (paths[picture_of(span, len(paths), k) - 1].name for k in range(span.first, span.end))
        still = span.shot.picture != MAP and span.shot.seconds / len(paths) > _HELD
        return Reel(span, paths[0].parent.relative_to(self.pictures.out).as_posix(), tuple(shown), still)

    def _markers(self, spans: list[Span]) -> Iterator[tuple[int, str]]:
        """Yield frame and text of events of the run that a map shows."""
        run, places = self.pictures.run, self.pictures.places
        happened = [*events.ignitions(run), *events.arrivals_at(run, labels.find(run, places))]
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


def cut(project: Project, overwrite: bool, progress: Progress, tell: MessageCallback) -> list[Path]:
    """Lay out the project in its file, render its film, and write its cut; in a worker process."""
    import bpy

    from ..jobs import build
    from ..render import timecode_track, verify
    from . import sequencer

    if project.path.is_file():
        _open(project.path)
    else:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        sequencer.set_up(bpy.data.scenes[0])
    if sequencer.SCENE_NAME not in bpy.data.scenes:
        raise input_error(project.path, f"has no scene {sequencer.SCENE_NAME}; rename or delete the file")
    sequencer.lay_out(bpy.data.scenes[sequencer.SCENE_NAME], project)
    edit = sequencer.describe_cut(bpy.data.scenes[sequencer.SCENE_NAME], FILM)
    build.save(project.path, tell)
    film = project.path.with_name(FILM)
    progress(0, 1, "filming")

    def put(part: Path) -> None:
        _open(project.path)  # so that paths relative to it are valid
        bpy.data.scenes[sequencer.SCENE_NAME].render.filepath = str(part)
        with writing(film):
            bpy.ops.render.render(animation=True, scene=sequencer.SCENE_NAME)
        timecode_track.add(part, timecode.count_of_frame(1, edit.rate), edit.rate)
        verify.film(part)

    output.write(film, put, overwrite)
    progress(1, 1, "filming")
    return interchange.write(edit, project.path.parent, CUT, tell, overwrite)


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
