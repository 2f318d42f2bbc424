"""Sections of the page: title, burned area, film, scores, sources and licences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import firetwin_core

from ..html_text import quote, size
from ..run import methods, times
from ..run.readers import folder
from ..run.score import report, used
from ..stations.records import EXERCISE, Source
from . import curve, units
from .briefing import Briefing
from .film import CLIP, WIDTH, Film, Shown

_LEAFLET = Path(__file__).parent / "leaflet"
_NOT_KNOWN = "licence unknown to Firetwin; see the publisher"


def head(briefing: Briefing) -> str:
    """Build times, warnings and key facts below the title."""
    return "\n".join(_head(briefing))


def _head(briefing: Briefing) -> Iterator[str]:
    first, last = briefing.fronts[0], briefing.fronts[-1]
    utc = f"{first.utc:%d %b %Y %H:%M} to {last.utc:%d %b %Y %H:%M} UTC"
    yield f'<p class="soft">{quote(briefing.moments[0])} to {quote(briefing.moments[-1])} ({utc})</p>'
    warnings = []
    if briefing.run.synthetic:
        warnings.append(
            "<b>This run is synthetic</b>, not the output of a fire model. "
            "It does not show where a fire burned or will burn."
        )
    if briefing.exercise:
        warnings.append(f"<b>{EXERCISE}.</b>")
    for head, text in folder.warnings(Path(briefing.run.path), briefing.zone):
        warnings.append(f"<b>{quote(head)}</b> {quote(text)}")
    if warnings:
        yield f'<p class="warn">{"<br>".join(warnings)}</p>'
    grid = briefing.facts["grid"]
    order = briefing.units
    extent = " x ".join(units.distance(side, order) for side in reversed(grid["extent"]))
    named = ("acres", "miles", "hectares", "km") if order == "us" else ("hectares", "km", "acres", "miles")
    facts = (
        ("Burned area at the start", units.area(first.area, order)),
        ("Burned area at the end", units.area(last.area, order)),
        ("Extent of the run", extent),
        ("Units", f"{', '.join(named)}, {units.FUEL[order].name}; times are UTC and {briefing.zone}"),
    )
    pairs = "".join(f"<div><dt>{name}</dt><dd>{quote(value)}</dd></div>" for name, value in facts)
    yield f'<dl class="facts">{pairs}</dl>'


def growth(briefing: Briefing) -> str:
    """Build the chart of burned area, and a table that compares reports with the run."""
    reported = briefing.facts["reported"]
    key = '<span><i style="background:var(--fire)"></i>this run</span>'
    rows = [row for row in reported if row["run"] is not None]
    if rows:
        key += '<span><i style="background:var(--ink);border-radius:50%"></i>reported</span>'
    outside = len(reported) - len(rows)
    more = (
        f"<p class='soft'>{outside} other reports are from before or after this run.</p>" if outside else ""
    )
    drawn = curve.svg(briefing.fronts, reported, briefing.zone, briefing.units)
    table = _reports(rows, briefing) if rows else ""
    return f'<div class="key">{key}</div><figure>{drawn}</figure>{table}{more}'


def _reports(rows: Sequence[dict[str, Any]], briefing: Briefing) -> str:
    zone, synthetic = briefing.zone, briefing.run.synthetic
    unit = units.AREA[briefing.units]
    lines = "".join(
        f"<tr><td>{quote(times.text(datetime.fromisoformat(row['time']), zone))}</td>"
        f"<td>{unit.format(row['run'])}</td>"
        f"<td>{unit.format(row['reported'])}</td>"
        f"<td>{round(100 * row['difference'], 1) + 0.0:+.1f} %</td>"
        f'<td class="text">{quote(row["source"])}<small>{quote(row["note"])}</small></td></tr>\n'
        for row in rows
    )
    titles = ("time", f"run, {unit.name}", f"reported, {unit.name}", "difference")
    head = "".join(f'<th scope="col">{title}</th>' for title in titles)
    tuned = (
        '<p class="soft">The synthetic run was tuned to these reports; agreement does not validate it.</p>'
        if synthetic
        else ""
    )
    return (
        f'<div class="wide"><table><thead><tr>{head}<th scope="col" class="text">source</th></tr></thead>'
        f"<tbody>{lines}</tbody></table></div>{tuned}"
    )


def film(briefing: Briefing) -> str:
    """Build the gallery of frames and clips; empty without a film."""
    if briefing.film is None:
        return ""
    shown = briefing.film
    frames = "".join(_frame(briefing, each) for each in shown.frames)
    clips = "".join(_clip(each) for each in shown.clips)
    parts = [f'<div class="gallery">{frames}</div>'] if frames else []
    if clips:
        parts.append(f'<h3 class="screen">Clips</h3><div class="gallery screen">{clips}</div>')
    return (
        '<section aria-labelledby="film-title"><h2 id="film-title">Pictures</h2>'
        f"{''.join(parts)}{_left_out(shown)}"
        f'<p class="soft">Rendered with Blender from this run, at most {WIDTH} pixels wide here. '
        "They visualise the run and are not photographs.</p></section>"
    )


def _frame(briefing: Briefing, shown: Shown) -> str:
    title = quote(f"{shown.camera}, {shown.name}")
    when = "" if shown.time is None else f"<br>{quote(times.text(shown.time, briefing.zone))}"
    utc = "" if shown.time is None else f" ({shown.time:%d %b %H:%M} UTC)"
    return (
        f'<figure><img src="{shown.uri}" data-view="{title}" alt="Rendered picture of {title}">'
        f"<figcaption><b>{title}</b>{when}{utc}</figcaption></figure>"
    )


def _clip(shown: Shown) -> str:
    title = quote(f"{shown.camera}, {shown.name}")
    return (
        f'<figure><video controls muted playsinline preload="metadata" src="{shown.uri}" data-view="{title}" '
        f'aria-label="Clip of {title}"></video><figcaption><b>{title}</b></figcaption></figure>'
    )


def _left_out(shown: Film) -> str:
    if not shown.left_out:
        return ""
    items = "".join(f"<li>{quote(text)}</li>" for text in shown.left_out)
    title = f"Omitted from this page (limit of a clip: {size(CLIP)}):"
    return f'<p class="soft">{title}</p><ul class="soft">{items}</ul>'


def scores(briefing: Briefing) -> str:
    """Build the tables of scores with their errors; empty without observations."""
    if briefing.scores is None and not briefing.no_scores:
        return ""
    if briefing.scores is None:
        inside = f'<p class="warn">Not computed: {quote(briefing.no_scores)}</p>'
    else:
        area, separation = units.AREA[briefing.units], units.SEPARATION[briefing.units]
        inside = "".join(report.tables(briefing.scores, area, separation))
        none = used.nothing(briefing.scores["uses"])
        if not none and briefing.run.synthetic:
            warning = "Scores of a synthetic run show that the tools work; they say nothing about a model."
            inside = f'<p class="soft">{warning}</p>{inside}'
    title = '<h2 id="scores-title">Scores against observations</h2>'
    return f'<section aria-labelledby="scores-title">{title}{inside}</section>'


def method(briefing: Briefing) -> str:
    """Build the paragraph on methods, for a paper."""
    found = dict(reversed(briefing.inputs))
    inputs = methods.Inputs(
        elevation=found.get("Elevation model", ""),
        observations=[name for what, name in briefing.inputs if what == "Observations" and briefing.scores],
        sentences=briefing.sentences,
        rendered=briefing.film.versions if briefing.film else (),
        exercise=briefing.exercise,
    )
    return f"<p>{quote(methods.paragraph(briefing.run, inputs))}</p>"


def sources(briefing: Briefing) -> str:
    """Build the list of all sources with their licences."""
    printed = "".join(f"<li>{item}</li>" for item in _sources(briefing))
    more = "".join(f'<li class="screen">{item}</li>' for item in _details(briefing))
    items = printed + more
    licence = quote((_LEAFLET / "LICENSE").read_text(encoding="utf-8").replace("\n", "\f")).replace(
        "\\x0c", "\n"
    )
    return (
        f'<ul class="sources">{items}</ul>'
        f'<details class="screen"><summary>Licence of Leaflet 1.9.4</summary><pre>{licence}</pre></details>'
    )


def _sources(briefing: Briefing) -> Iterator[str]:
    run, source = briefing.run, briefing.facts["source"]
    source = source if isinstance(source, dict) else {}
    made = f", made from {source['model']}" if source.get("model") else ""
    kind = "; synthetic, written by Firetwin (GPL-3.0-or-later)" if run.synthetic and not made else ""
    licence = "" if kind else f"; {_NOT_KNOWN}"
    yield (
        f"<b>Run</b>: {quote(run.name)}{quote(made)}{kind}{licence}. "
        "Source of terrain, fuel, arrival times and fronts; fronts on the map are simplified by at most "
        f"{briefing.tolerance:.3g} m."
    )
    if assumed := source.get("assumptions", []):
        yield f"<b>Assumptions of the run</b>: {len(assumed)}, which the page lists on the screen"
    for what, name in briefing.inputs:
        yield f"<b>{what}</b>: {quote(name)}; {_NOT_KNOWN}"
    if briefing.facts["reported"]:
        yield "<b>Reported areas</b>: figures as published by the agencies and newspapers named in the table"
    if any(point.station is None for point in briefing.points) and not any(
        what == "Named places" for what, _ in briefing.inputs
    ):
        yield "<b>Named places</b>: positions from gazetteers (data/king_fire.toml of Firetwin)"
    for each in briefing.station_file.sources if briefing.station_file else ():
        yield f"<b>Stations and resources</b>: {_source(each)}"
    if briefing.film:
        yield "<b>Pictures and clips</b>: rendered by Firetwin with Blender from this run"
    yield f"<b>This page</b>: Firetwin {firetwin_core.__version__}, GPL-3.0-or-later"


def _details(briefing: Briefing) -> Iterator[str]:
    """List what concerns the page on the screen alone."""
    source = briefing.facts["source"] if isinstance(briefing.facts["source"], dict) else {}
    for text in source.get("assumptions", []):
        yield f"<b>Assumption of the run</b>: {quote(text)}"
    if briefing.points:
        yield (
            "<b>Open in web map</b>: links to openstreetmap.org, whose map is © OpenStreetMap contributors "
            "(ODbL). This page contains no data of that map and loads none until a link is followed"
        )
    yield (
        '<b>Map script</b>: <a href="https://leafletjs.com" rel="noopener noreferrer">Leaflet</a> 1.9.4, '
        "© 2010-2023 Volodymyr Agafonkin, © 2010-2011 CloudMade, BSD-2-Clause (below)"
    )


def _source(source: Source) -> str:
    date = f", data of {source.retrieved}" if source.retrieved else ", date of the data unknown"
    name = quote(source.name)
    if source.url.startswith(("https://", "http://")):
        name = f'<a href="{quote(source.url)}" rel="noopener noreferrer">{name}</a>'
    return f"{name}{quote(date)}; licence: {quote(source.licence or 'unknown')}"
