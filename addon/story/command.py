"""`firetwin story`: one film that tells a fire."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite, add_scene

_DETAIL = """\
DIR/story.toml           storyboard: shots with reason, times, camera and caption
DIR/story.srt, .vtt      captions
DIR/story.json           report: reasons, sources, and each number of a caption with its model time
DIR/shots/NAME           pictures of a shot; shots/NAME.toml is its scene file
DIR/story.blend          project of Blender's Video Sequencer
DIR/story.mp4            the film, which Blender renders from the project
DIR/story.otio, .xml     its cut for other programs, as of firetwin edit; story.edl, too

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
    parser.add_argument(
        "--time-lapse", action="store_true", help="add all hours in 30 s with smoke, which takes minutes"
    )
    parser.add_argument("--units", choices=("us", "metric"), default="us", help="units of captions (us)")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the story of a run or scene."""
    from ..progress import Reporter, result, say
    from . import job

    request = job.StoryRequest(
        arguments.scene,
        arguments.out,
        not arguments.storyboard,
        purpose=arguments.purpose,
        units=arguments.units,
        lapse=arguments.time_lapse,
        quality=arguments.quality,
        size=arguments.size,
        resume=arguments.resume,
        overwrite=arguments.overwrite,
    )
    for path in job.run(request, Reporter(), say):
        result(path)


COMMAND = Command("story", "make one film that tells a fire", _DETAIL, FILMS, _run, _add)
