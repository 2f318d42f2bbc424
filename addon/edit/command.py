"""`firetwin edit`: a cut of the films of a scene."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite, add_scene

STEM = "film"

_DETAIL = """\
Writes film.otio, film.xml (Final Cut Pro 7 XML) and film.edl (CMX 3600) of the films of firetwin render.
Track V1 is a cut of the cameras in the order of the scene file; the tracks above have one camera each and
are disabled. Markers show ignition, flare-ups, and the fire's arrival at towns and stations. The EDL has only
V1."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=types.path,
        required=True,
        help="folder to write, usually of firetwin render",
    )
    parser.add_argument(
        "--film", metavar="DIR", type=types.path, help="folder of firetwin render, if another"
    )
    parser.add_argument(
        "--pass", dest="name", metavar="NAME", type=types.name, default="rgb", help="pass of the films (rgb)"
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the edit of a scene's films.

    Raises
    ------
    UsageError
        There is no such pass.
    """
    from ..auto_framing import fitted_scene
    from ..cuts import interchange
    from ..cuts.cut import Edit, cut
    from ..did_you_mean import suggestion
    from ..errors import UsageError
    from ..escaped import escaped
    from ..progress import count, result, say
    from ..shot import passes
    from ..shot.runs import scene_runs
    from . import markers, media

    interchange.check(arguments.out, STEM, arguments.overwrite)
    shot = fitted_scene.find_source(arguments).shot()
    known = [name for name, each in passes.known().items() if each.film]
    if arguments.name not in known:
        hint = suggestion(arguments.name, known)
        raise UsageError(f'--pass: "{arguments.name}" is not one of {", ".join(known)}{hint}')
    films_of_cameras = media.films(shot, arguments.name, arguments.film or arguments.out, arguments.out)
    edit = Edit(
        escaped(shot.settings.path.stem),
        shot.settings.time.rate,
        tuple(films_of_cameras),
        tuple(cut(films_of_cameras)),
        tuple(markers.find(shot)),
    )
    used = {film.camera for film in films_of_cameras}
    if omitted := [view for view in scene_runs.views(shot.settings) if view not in used]:
        say(f"omitted panoramas, other runs' views and cameras without a film: {', '.join(omitted)}")
    clips, films = count(len(edit.cut), "clip"), count(len(films_of_cameras), "film")
    say(f"cut {clips} of {films}, {count(len(edit.markers), 'marker')}")
    for path in interchange.write(edit, arguments.out, STEM, say, arguments.overwrite):
        result(path)


COMMAND = Command("edit", "cut films into OTIO, Final Cut Pro XML and EDL files", _DETAIL, FILMS, _run, _add)
