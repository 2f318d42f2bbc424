"""`firetwin cite`: the sources to cite, and archives of films."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import Reporter, result
from ._scene_runs import is_scene, list_runs

if TYPE_CHECKING:
    from ..shot.shot import Shot


_DETAIL = """\
Lists software, algorithms, fire model, facts about the fire, and files of observations. For a scene file, it
also lists the credits of terrain, imagery and tiles, which their licences require. --crate writes
DIR/ro-crate-metadata.json: it describes the files of a film, its run, software and sources for an archive."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run or ensemble folder, or a scene file")
    parser.add_argument("--json", action="store_true", help="write JSON")
    parser.add_argument(
        "--crate",
        metavar="DIR",
        type=types.path,
        help="write an RO-Crate of the film in DIR, a folder of render",
    )
    parser.add_argument(
        "--license", metavar="URL", default="", dest="licence", help="licence of the film, for --crate"
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """List the sources that a work with a run, an ensemble or a film has to cite."""
    from ..errors import UsageError
    from ..run import citations, readers
    from ..shot.source import ShotSource

    if arguments.licence and not arguments.crate:
        raise UsageError("--license: is of --crate; name the folder of the film")
    if is_scene(arguments.run):
        shot = ShotSource(scene=str(arguments.run)).shot()
        rows = _sources(shot)
        if arguments.crate:
            result(_write_crate(shot, rows, arguments))
            return
    else:
        rows = citations.of_run(readers.open(arguments.run))
    if arguments.crate:
        raise UsageError(f"--crate: {arguments.run} is not a scene file; name the scene file of the film")
    citations.show(rows, arguments.json)


def _sources(shot: Shot) -> list[dict[str, str]]:
    """List the sources of a film, each once: of its runs, its forecast, and its pictures."""
    from ..run import citations
    from ..shot import picture_credits, scene_inputs

    rows = [row for run in list_runs(shot).values() for row in citations.of_run(run)]
    rows += scene_inputs.sources(shot.settings)
    credits = picture_credits.of_shot(shot)
    rows += [{"kind": "pictures", "text": text} for text in (*credits.data, *credits.logo)]
    return list({row["text"]: row for row in rows}.values())


def _write_crate(shot: Shot, rows: list[dict[str, str]], arguments: argparse.Namespace) -> Path:
    """Describe the files of a film for archives."""
    from .. import output
    from ..render import crate, manifest
    from ..run import content, methods
    from ..shot import scene_inputs

    out, terrain = arguments.crate, shot.settings.terrain
    output.check(out / crate.NAME, arguments.overwrite)
    report = Reporter("input hashes")
    runs = {
        label: (run.name, content.inputs(run, shot.settings.cache, (), report))
        for label, run in list_runs(shot).items()
    }
    inputs = methods.Inputs(
        elevation=terrain.elevation.name if terrain.elevation else "",
        sentences=scene_inputs.sentences(shot.settings),
        rendered=manifest.versions(manifest.read(out)["settings"].values()),
    )
    text = methods.paragraph(shot.run, inputs)
    return crate.write(out, runs, text, rows, arguments.licence, arguments.overwrite)


COMMAND = Command("cite", "list the sources to cite with a run or a film", _DETAIL, RUNS, _run, _add)
