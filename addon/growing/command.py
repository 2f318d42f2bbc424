"""`firetwin watch`: the output of a model that is still running."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from .. import argument_types as types
from ..command import RUNS, Command, Extension, add_origin, add_overwrite
from ..progress import result, say

_DETAIL = """\
Polls the files of WRF-SFIRE, CFBM, or CF netCDF or zarr with a heat flux. It locks no file, so that the model
can go on writing. A time is complete when the model's log (rsl.error.0000) names it, or a later time exists.
Otherwise it is guessed: size and modification time of its file are equal in two polls.

DIR/times.json              accepted times: file, reason, hash of the values
DIR/status.json, index.html state: waiting, running, stalled, ended, failed or restarted
DIR/generation_1/000012     run of the first 12 times

Commands accept DIR as a run; its newest times are read. If the model starts again, generation_2 begins.
3D fields are not converted; use `convert` when the model has ended. Repeating the command continues a watch.
The exit status is 1 if the model failed."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "run",
        metavar="RUN",
        nargs="+",
        type=types.path,
        help="file or folder that the model writes; then further files, such as a mapping",
    )
    parser.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder to write")
    parser.add_argument(
        "--every", metavar="SECONDS", type=types.count, default=5, help="time between polls, s (5)"
    )
    parser.add_argument(
        "--end",
        metavar="TIME",
        type=types.moment,
        help="last model time, such as 2014-09-17T16:00-07:00 (from the log of the model)",
    )
    parser.add_argument(
        "--idle",
        metavar="SECONDS",
        type=types.count,
        default=0,
        help="end if the files have not changed for this time, s (never)",
    )
    add_origin(parser)
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> int:
    """Convert the output of a model that is still running."""
    from . import watch

    source, *extra = arguments.run
    request = watch.WatchRequest(
        source=source,
        extra=tuple(extra),
        out=arguments.out,
        every=float(arguments.every),
        end=arguments.end,
        idle=float(arguments.idle),
        start=arguments.start,
        at=arguments.at,
        projection=arguments.projection,
        name=arguments.name,
        zone=arguments.zone,
        overwrite=arguments.overwrite,
    )
    state = watch.run(request, say)
    result(arguments.out)
    return 1 if state == "failed" else 0


_FOLLOW = """\
--follow films a run that `watch` writes. A frame is rendered when the next model time exists, from the times
up to it, so that it equals the frame that --follow renders when the model has ended. Exposure is metered in
the first frame and kept. Cameras that follow the fire are an error. Films are replaced as a whole."""


def _add_follow(parser: argparse.ArgumentParser) -> None:
    """Define the option of `render`."""
    parser.add_argument(
        "--follow",
        action="store_true",
        help="render each frame when the next model time of a growing run exists (see watch)",
    )


def _choose_job(arguments: argparse.Namespace, job: Callable) -> Callable:
    """Replace the job of `render` if it follows a growing run."""
    if not arguments.follow:
        return job
    from . import follow

    return follow.run


COMMAND = Command("watch", "convert the output of a model that is still running", _DETAIL, RUNS, _run, _add)
EXTENSIONS = (Extension("render", _add_follow, amend=_choose_job, detail=_FOLLOW),)
