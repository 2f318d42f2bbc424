"""Ensembles in commands of other features: `info`, `score`, `cite`, `convert`, `sample`, and `--ensemble`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .. import argument_types as types
from ..command import Extension
from ..progress import Reporter, result, say

if TYPE_CHECKING:
    from .ensemble.ensemble import Ensemble


def _of_ensemble(run: Callable[[Ensemble, argparse.Namespace], None]) -> Callable:
    """Run a command if its run is an ensemble."""

    def start(arguments: argparse.Namespace) -> int | None:
        from .ensemble import ensemble

        if not ensemble.sniff(arguments.run):
            return None
        run(ensemble.open(arguments.run), arguments)
        return 0

    return start


def _info(ensemble: Ensemble, arguments: argparse.Namespace) -> None:
    from .ensemble import summary

    facts = summary.gather(ensemble)
    result(json.dumps(facts, indent=1) if arguments.json else summary.page(facts))


def _cite(ensemble: Ensemble, arguments: argparse.Namespace) -> None:
    from ..errors import UsageError
    from ..run import citations
    from .ensemble import describe

    if arguments.licence and not arguments.crate:
        raise UsageError("--license: is of --crate; name the folder of the film")
    if arguments.crate:
        raise UsageError(f"--crate: {arguments.run} is not a scene file; name the scene file of the film")
    citations.show(describe.sources(ensemble), arguments.json)


def _score(ensemble: Ensemble, arguments: argparse.Namespace) -> None:
    """Compare an ensemble with observed perimeters."""
    from ..errors import UsageError
    from ..run import observations, zone
    from . import member_scores

    named = arguments.against or observations.beside(arguments.run)
    if arguments.report:
        raise UsageError("--report: is of runs alone; use --json for the scores of an ensemble")
    if not named or not all(observations.is_one(each) for each in named):
        raise UsageError("--against: name files of observed perimeters")
    clock = ensemble.manifest.zone or zone.of_longitude(float(ensemble.longitude.mean()))
    results = member_scores.score(ensemble, observations.read(named), clock)
    result(json.dumps(results, indent=1) if arguments.json else member_scores.page(results))


def _add_convert(parser: argparse.ArgumentParser) -> None:
    """Define the options of `convert`."""
    parser.add_argument(
        "--members",
        action="store_true",
        help="convert all members of a forecast to an ensemble (a model's output, a folder or list of runs)",
    )
    parser.add_argument(
        "--horizon",
        metavar="HOURS",
        type=types.hours,
        default=0,
        help="length of the forecast of --members (of its longest member)",
    )


def _convert(arguments: argparse.Namespace) -> int | None:
    """Convert members to an ensemble."""
    from ..errors import UsageError
    from . import convert

    if not arguments.members:
        return None
    if arguments.wind:
        raise UsageError("--wind: members have arrival times alone; give it with --member")
    options = arguments.start, arguments.at, arguments.projection, arguments.horizon * 3600.0
    names = {"name": arguments.name, "zone": arguments.zone}
    result(convert.run(arguments.paths, arguments.out, *options, tell=say, **names))
    return 0


def _add_sample(parser: argparse.ArgumentParser) -> None:
    """Define the option of `sample`."""
    parser.add_argument(
        "--members", metavar="N", type=types.count, help="write a synthetic ensemble of N members instead"
    )


def _sample(arguments: argparse.Namespace) -> int | None:
    """Write the synthetic ensemble."""
    from ..errors import UsageError
    from .ensemble import synthetic

    if arguments.members is None:
        return None
    if arguments.member or arguments.pace != 1.0 or arguments.frames is not None:
        raise UsageError("--members: has arrival times alone; leave out --member, --pace and --frames")
    synthetic.write(arguments.out, arguments.members, Reporter("members"))
    result(arguments.out)
    return 0


def _add_ensemble(help: str) -> Callable[[argparse.ArgumentParser], None]:
    """Define the option `--ensemble`, with its help."""

    def add(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--ensemble", metavar="DIR", type=types.path, help=f"{help} (none)")

    return add


def _amend_brief(arguments: argparse.Namespace, briefing: Any) -> Any:
    """Add the section of an ensemble to the briefing page."""
    from . import brief_section

    return brief_section.add(briefing, arguments.ensemble) if arguments.ensemble else briefing


def _amend_resources(arguments: argparse.Namespace, answer: Any) -> Any:
    """Add the arrival of members at stations."""
    from .ensemble import place_arrivals
    from .station_arrivals import MemberArrivals

    if not arguments.ensemble:
        return answer
    ensemble = place_arrivals.open_forecast(arguments.ensemble, "the list")
    members = MemberArrivals.at(ensemble, [each.station for each in answer.matches], answer.run)
    return replace(answer, further=(*answer.further, members))


def _amend_allocation(arguments: argparse.Namespace, suggested: Any) -> Any:
    """Add the arrival of members at control lines."""
    from . import line_arrivals
    from .ensemble import place_arrivals

    if arguments.ensemble:
        members = place_arrivals.open_forecast(arguments.ensemble, "the list")
        lines = line_arrivals.add(suggested.suggestion, suggested.run, members, suggested.drawn)
        suggested.lines.update(lines)
    return suggested


_TIMES = "forecast of many members: times by which 10 and 50 %% of them"
_RESOURCES = """\
With --ensemble the list gives the number of members of a forecast that burn each station by when. Without
--run, --ahead then lists the stations that a tenth of the members reach."""

EXTENSIONS = (
    Extension("info", run=_of_ensemble(_info), detail="An ensemble has its members and their areas."),
    Extension("cite", run=_of_ensemble(_cite)),
    Extension(
        "score", run=_of_ensemble(_score), detail="For an ensemble: CRPS, Brier score, reliability and FSS."
    ),
    Extension("convert", _add_convert, run=_convert),
    Extension("sample", _add_sample, run=_sample),
    Extension("brief", _add_ensemble("ensemble of the forecast"), amend=_amend_brief),
    Extension(
        "resources", _add_ensemble(f"{_TIMES} burn each station"), amend=_amend_resources, detail=_RESOURCES
    ),
    Extension("allocate", _add_ensemble(f"{_TIMES} reach each control line"), amend=_amend_allocation),
)
