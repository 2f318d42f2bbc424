"""`firetwin story`: one film that tells a fire."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite, add_scene

if TYPE_CHECKING:
    from pathlib import Path

    from firetwin_core.run import Run

    from .captions import Caption
    from .storyboard import Storyboard

_DETAIL = """\
DIR/story.toml           storyboard: shots with reason, times, camera and caption
DIR/story.srt, .vtt      captions
DIR/story.json           report: reasons, sources, and each number of a caption with its model time
DIR/shots/NAME           pictures of a shot; shots/NAME.toml is its scene file
DIR/story.blend          project of Blender's Video Sequencer
DIR/story.mp4            the film, which Blender renders from the project

The storyboard is chosen from the run if DIR has none; otherwise the storyboard there is used, with all its
changes. Shots that the run cannot give are listed with the reason. Numbers in captions are computed from the
run. In the project, strips that you moved, cut or rewrote stay; the others follow the storyboard."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder to write")
    parser.add_argument(
        "--storyboard", action="store_true", help="write the storyboard and the captions only"
    )
    parser.add_argument(
        "--quality",
        choices=("draft", "review", "final"),
        default="draft",
        help="draft: stills with slow moves; review: 12 pictures a second; final: all frames (draft)",
    )
    parser.add_argument(
        "--size", metavar="WxH", type=types.resolution, help="size of the pictures (by quality)"
    )
    parser.add_argument(
        "--resume", action="store_true", help="keep finished pictures whose inputs have not changed"
    )
    parser.add_argument(
        "--for",
        dest="purpose",
        choices=("briefing", "training"),
        default="briefing",
        help="training: the growth pauses at decisions, and DIR/instructor.html has the answers (briefing)",
    )
    parser.add_argument("--units", choices=("us", "metric"), default="us", help="units of captions (us)")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the story of a run or scene."""
    from .. import output
    from ..progress import result, say
    from ..run import readers
    from . import captions, report, story_file, timeline, training

    paths = [arguments.out / f"story.{suffix}" for suffix in ("srt", "vtt", "json")]
    for path in paths:
        output.check(path, arguments.overwrite)
    story = _storyboard(arguments)
    for each in story.omitted:
        say(f"omitted: {each.name}: {each.reason}")
    spans, run = timeline.lay_out(story), readers.open(story.run)
    shown = captions.make(story, spans, run)
    say(f"{len(spans)} shots, {timeline.frames(spans) / story.fps:.0f} s")
    texts = captions.srt(shown, story.fps), captions.vtt(shown, story.fps), report.text(story, shown, run)
    for path, text in zip(paths, texts, strict=True):
        output.write_text(path, text, arguments.overwrite, newline="\n")
    if any(shot.name.startswith(training.QUESTION) for shot in story.shots):
        paths.append(arguments.out / "instructor.html")
        output.write_text(paths[-1], training.sheet(story, spans, run), arguments.overwrite)
    paths.insert(0, arguments.out / story_file.NAME)
    if not arguments.storyboard:
        paths += _film(arguments, story, run, shown)
    for path in paths:
        result(path)


def _film(arguments: argparse.Namespace, story: Storyboard, run: Run, shown: list[Caption]) -> list[Path]:
    """Render the film of a storyboard with these captions."""
    from dataclasses import replace

    from ..progress import Reporter, say
    from ..shot.settings import scene_file
    from .film import Film
    from .quality import QUALITIES

    quality = QUALITIES[arguments.quality]
    if arguments.size:
        quality = replace(quality, resolution=arguments.size)
    places = scene_file.read(story.scene).labels.file if story.scene else None
    film = Film(story, run, quality, shown, places, arguments.overwrite)
    return film.make(arguments.resume, Reporter(), say)


def _storyboard(arguments: argparse.Namespace) -> Storyboard:
    """Read the storyboard of the folder; without one, choose and write it."""
    from .. import output
    from ..progress import say
    from ..run import labels, readers
    from ..run.readers import folder
    from ..shot.settings import scene_file
    from . import choose, story_file, training

    path = arguments.out / story_file.NAME
    if path.exists() and not arguments.overwrite:
        say(f"using the shots of {path}; delete it to choose them again")
        return story_file.read(path)
    scene, place = arguments.scene, None
    run_folder = scene
    if folder.sniff(scene):
        scene = None
    else:
        settings = scene_file.read(scene)
        run_folder, place = settings.run, settings.labels.file
    run = readers.open(run_folder)
    story = choose.choose(run, path, scene, place, arguments.units)
    if arguments.purpose == "training":
        story = training.with_decisions(story, run, labels.find(run, place))
    output.write_text(path, story_file.text(story), arguments.overwrite, newline="\n")
    return story


COMMAND = Command("story", "make one film that tells a fire", _DETAIL, FILMS, _run, _add)
