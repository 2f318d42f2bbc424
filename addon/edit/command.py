"""The command `firetwin edit`."""

from __future__ import annotations

import argparse

from .. import files
from ..errors import UsageError
from ..progress import count, result, say
from ..shot import passes
from ..shot.runs import scene_runs
from ..shot.schema.did_you_mean import suggestion
from ..shot.shot import Shot
from . import cut, edl, fcp_xml, markers, media, otio

STEM = "film"
_FORMATS = {".otio": otio.text, ".xml": fcp_xml.text, ".edl": edl.text}


def run(arguments: argparse.Namespace, shot: Shot) -> None:
    """Write the edit of a scene's films.

    Raises
    ------
    UsageError
        There is no such pass.
    """
    known = [name for name, each in passes.known().items() if each.film]
    if arguments.name not in known:
        hint = suggestion(arguments.name, known)
        raise UsageError(f'--pass: "{arguments.name}" is not one of {", ".join(known)}{hint}')
    found = media.films(shot, arguments.name, arguments.film or arguments.out, arguments.out)
    made = cut.Edit(
        shot.settings.path.stem,
        shot.settings.time.rate,
        tuple(found),
        tuple(cut.cut(found)),
        tuple(markers.find(shot)),
    )
    used = {film.camera for film in found}
    if omitted := [view for view in scene_runs.views(shot.settings) if view not in used]:
        say(f"omitted panoramas, other runs' views and cameras without a film: {', '.join(omitted)}")
    clips, films = count(len(made.cut), "clip"), count(len(found), "film")
    say(f"cut {clips} of {films}, {count(len(made.markers), 'marker')}")
    for suffix, text in _FORMATS.items():
        path = arguments.out / f"{STEM}{suffix}"
        files.write_text(path, text(made), newline="\n")
        result(path)
