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
    from .. import output, timecode
    from ..auto_framing import fitted_scene
    from ..did_you_mean import suggestion
    from ..errors import UsageError, writing
    from ..escaped import escaped
    from ..progress import count, result, say
    from ..shot import passes
    from ..shot.runs import scene_runs
    from . import cut, edl, fcp_xml, markers, media, otio

    for suffix in (".otio", ".xml", ".edl"):
        output.check(arguments.out / f"{STEM}{suffix}", arguments.overwrite)
    shot = fitted_scene.find_source(arguments).shot()
    formats = {".otio": otio.text, ".xml": fcp_xml.text, ".edl": edl.text}
    known = [name for name, each in passes.known().items() if each.film]
    if arguments.name not in known:
        hint = suggestion(arguments.name, known)
        raise UsageError(f'--pass: "{arguments.name}" is not one of {", ".join(known)}{hint}')
    rate = shot.settings.time.rate
    if timecode.nominal_rate(rate) not in edl.RATES:
        del formats[".edl"]
        reason = f"an EDL has no timecode at {timecode.format_rate(rate)} frames per second"
        say(f"left out {STEM}.edl: {reason}; use {STEM}.otio or {STEM}.xml, or set [time] fps = 24")
    films_of_cameras = media.films(shot, arguments.name, arguments.film or arguments.out, arguments.out)
    edit = cut.Edit(
        escaped(shot.settings.path.stem),
        rate,
        tuple(films_of_cameras),
        tuple(cut.cut(films_of_cameras)),
        tuple(markers.find(shot)),
    )
    used = {film.camera for film in films_of_cameras}
    if omitted := [view for view in scene_runs.views(shot.settings) if view not in used]:
        say(f"omitted panoramas, other runs' views and cameras without a film: {', '.join(omitted)}")
    clips, films = count(len(edit.cut), "clip"), count(len(films_of_cameras), "film")
    say(f"cut {clips} of {films}, {count(len(edit.markers), 'marker')}")
    for suffix, text in formats.items():
        path = arguments.out / f"{STEM}{suffix}"
        output.write_text(path, text(edit), arguments.overwrite, newline="\n")
        result(path)
    former = arguments.out / f"{STEM}.edl"
    if ".edl" not in formats and output.is_own(former):
        with writing(former):
            former.unlink()
        say(f"removed {former} of an earlier edit")


COMMAND = Command("edit", "cut films into OTIO, Final Cut Pro XML and EDL files", _DETAIL, FILMS, _run, _add)
