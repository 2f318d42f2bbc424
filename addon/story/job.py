"""Story of a run or a scene file, step by step: its storyboard, its captions and report, and its film."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from firetwin_core.run import Run

from .. import output
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, count, no_message, silent
from ..run import labels, readers
from ..run.readers import folder
from ..shot.settings import scene_file
from . import captions, choose, report, story_file, timeline, training
from .captions import Caption
from .film import Film
from .pictures import ShotPictures
from .quality import QUALITIES
from .storyboard import Storyboard

_SHEET = "instructor.html"


@dataclass(frozen=True)
class StoryRequest:
    """Request for a story.

    Attributes
    ----------
    source
        Run folder or scene file.
    film
        Render pictures and film; otherwise write the storyboard and the captions only.
    only
        Name of the shot whose pictures are rendered, without the film; empty: all.
    lapse
        Add the time-lapse with smoke.
    size
        Size of the pictures, if not the quality's.
    """

    source: Path
    out: Path
    film: bool = True
    only: str = ""
    purpose: str = "briefing"
    units: str = "us"
    lapse: bool = False
    quality: str = "draft"
    size: tuple[int, int] | None = None
    resume: bool = False
    overwrite: bool = False


def run(
    request: StoryRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: Stop | None = None,
) -> list[Path]:
    """Write the requested parts of a story, and return their files.

    The storyboard in the folder is used; without one, it is chosen.

    Raises
    ------
    InputError
        A file of others has the name of an output, or an input cannot be used.
    StoppedError
        `stop` was used; finished pictures remain.
    """
    texts = [request.out / f"story.{suffix}" for suffix in ("srt", "vtt", "json")]
    for path in [*texts, *[request.out / _SHEET] * (request.purpose == "training")]:
        output.check(path, request.overwrite)
    story = _storyboard(request, tell)
    for each in story.omitted:
        tell(f"omitted: {each.name}: {each.reason}")
    opened = readers.open(story.run)
    shown = _write_texts(request, story, opened, texts, tell)
    paths = [story.path, *texts]
    if request.film:
        paths += _film(request, story, opened, shown, progress, tell, stop)
    return paths


def _storyboard(request: StoryRequest, tell: MessageCallback) -> Storyboard:
    """Read the storyboard of the folder; without one, choose and write it."""
    path = request.out / story_file.NAME
    if path.exists() and not request.overwrite:
        tell(f"using the shots of {path}; delete it to choose them again")
        return story_file.read(path)
    scene, place, run_folder = None, None, request.source
    if not folder.sniff(request.source):
        scene = request.source
        settings = scene_file.read(scene)
        run_folder, place = settings.run, settings.labels.file
    opened = readers.open(run_folder)
    story = choose.choose(opened, path, scene, place, request.units, request.lapse)
    if request.purpose == "training":
        story = training.with_decisions(story, opened, labels.find(opened, place))
    story_file.write(story, request.overwrite)
    return story


def _write_texts(
    request: StoryRequest, story: Storyboard, opened: Run, paths: list[Path], tell: MessageCallback
) -> list[Caption]:
    """Write captions, report and the sheet of a training, which is added to `paths`; return the captions."""
    spans = timeline.lay_out(story)
    shown = captions.make(story, spans, opened)
    tell(f"{count(len(spans), 'shot')}, {timeline.frames(spans) / story.fps:.0f} s")
    texts = [
        captions.srt(shown, story.fps),
        captions.vtt(shown, story.fps),
        report.text(story, shown, opened),
    ]
    if any(shot.name.startswith(training.QUESTION) for shot in story.shots):
        paths.append(request.out / _SHEET)
        texts.append(training.sheet(story, spans, opened))
    for path, text in zip(paths, texts, strict=True):
        output.write_text(path, text, request.overwrite)
    return shown


def _film(
    request: StoryRequest,
    story: Storyboard,
    opened: Run,
    shown: list[Caption],
    progress: Progress,
    tell: MessageCallback,
    stop: Stop | None,
) -> list[Path]:
    """Render the film, or the pictures of one shot."""
    quality = QUALITIES[request.quality]
    if request.size:
        quality = replace(quality, resolution=request.size)
    places = scene_file.read(story.scene).labels.file if story.scene else None
    pictures = ShotPictures(story, opened, quality, places, request.overwrite)
    if request.only:
        return [pictures.make_shot(request.only, request.resume, progress, tell, stop)]
    return Film(pictures, shown).make(request.resume, progress, tell, stop)
