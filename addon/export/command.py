"""`firetwin export`: a scene for other programs."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite, add_scene
from .formats import known

_DETAIL = """\
Writes a scene for other programs, with its place on the Earth in DIR/georeference.json. Formats:
{formats}
Heights of a run above sea level become heights above the WGS84 ellipsoid by the height of the geoid: --geoid,
[tiles] geoid of the scene file, or EGM96 from a grid of this machine. Files of an earlier export are replaced
after all new files are complete, unless they changed."""


def _detail() -> str:
    """Describe the formats."""
    return _DETAIL.format(formats="\n".join(f"  {name:<6}{each.help}" for name, each in known().items()))


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument("--to", choices=tuple(known()), required=True, help="format")
    parser.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder to write")
    parser.add_argument("--frames", metavar="LIST", help="frames, such as 1-10, 3,5-9 or 1-48:4 (all)")
    parser.add_argument(
        "--geoid", metavar="M", type=types.undulation, help="height of the geoid above the WGS84 ellipsoid, m"
    )
    parser.add_argument("--no-smoke", action="store_true", help="omit the smoke volumes (usd)")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write a scene in a format, and list its files."""
    from ..auto_framing import fitted_scene
    from ..progress import Reporter, result, say
    from . import job
    from .request import ExportRequest

    source, smoke = fitted_scene.find_source(arguments), not arguments.no_smoke
    frames, reporter = arguments.frames or "", Reporter(arguments.to)
    request = ExportRequest(
        source, arguments.to, arguments.out, frames, arguments.geoid, smoke, reporter, say,
        overwrite=arguments.overwrite,
    )  # fmt: skip
    try:
        made = job.run(request)
    finally:
        reporter.close()
    for path in made:
        result(path)


COMMAND = Command("export", "write a scene for other programs", _detail, FILMS, _run, _add)
