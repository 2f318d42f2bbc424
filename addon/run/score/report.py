"""Score report as one self-contained HTML page: tables, maps and curves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from typing import Any

from firetwin_core.run import Run

from ...html_text import quote
from .. import times
from ..measure import ACRES, METRES, Measure
from . import plots, shapes, used
from .grid import ScoreGrid
from .overlap import HELP
from .page import arrival, local, said, theirs

_HELP = HELP | {"apart": "mean distance of the two perimeters from each other, and the largest (Hausdorff)"}
_SHOWN = ("sorensen", "jaccard", "kappa", "precision", "recall", "sdi", "adi")

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
"""Content security policy: the page loads nothing and runs no script."""

STYLE = """
:root{color-scheme:light;--ink:#1f2933;--soft:#5b6773;--line:#dde2e8}
*{box-sizing:border-box}
body{margin:0;background:#f4f5f7;color:var(--ink);
  font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:1060px;margin:0 auto;padding:36px 40px 60px;background:#fff;min-height:100vh}
h1{font-size:27px;line-height:1.2;margin:0 0 4px}h2{font-size:18px;margin:38px 0 10px}
p{margin:6px 0;max-width:78ch}.soft{color:var(--soft)}
.warn{border-left:4px solid #e8833a;background:#fdf3ea;padding:10px 16px;margin:18px 0;max-width:none}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums;margin:8px 0}
th,td{padding:6px 7px;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
th{font-weight:600;font-size:13px;color:var(--soft);border-bottom:2px solid #c3cad3;vertical-align:bottom}
th:first-child,td:first-child,.text{text-align:left}td.text{white-space:normal}
td small{display:block;color:var(--soft);font-size:12px;line-height:1.25}
.maps{display:grid;grid-template-columns:repeat(auto-fill,minmax(290px,1fr));gap:22px}
figure{margin:0}figure img,svg{width:100%;height:auto;display:block}
figcaption{font-size:13px;color:var(--soft);margin-top:6px}figcaption b{color:var(--ink)}
.key{display:flex;flex-wrap:wrap;gap:6px 22px;margin:6px 0 14px;font-size:14px}
.key i{display:inline-block;width:14px;height:14px;border-radius:3px;margin-right:7px;vertical-align:-2px}
.wide{overflow-x:auto}.one{max-width:560px}
dl{display:grid;grid-template-columns:auto 1fr;gap:3px 16px;font-size:14px}
dt{font-weight:600}dd{margin:0;color:var(--soft)}
@media print{body{background:#fff}main{padding:0}}
"""


def html(run: Run, results: dict[str, Any], seen: Any, other: Run | None = None) -> str:
    """Report of the scores `found` of a run against observations `seen` or against another run."""
    grid = ScoreGrid.from_run(run)
    name = quote(run.name)
    body = "\n".join(
        part
        for parts in (
            _head(run, results, other),
            _uses(results),
            _growth(run, results, other),
            _maps(run, grid, results, seen, other),
            _scores(results),
            _reported(run, grid, results),
            _more(results),
            _foot(results),
        )
        for part in parts
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}: scores</title>'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{STYLE}</style></head>'
        f"<body><main>\n{body}\n</main></body></html>\n"
    )


def tables(results: dict[str, Any], area: Measure = ACRES, distance: Measure = METRES) -> Iterator[str]:
    """Build the tables of scores against observations for another page; headings are h3.

    Parameters
    ----------
    area, distance
        Units of burned areas, and of the distance between perimeters.
    """
    for part in (_uses(results), _scores(results, area, distance), _more(results)):
        for text in part:
            yield text.replace("<h2>", "<h3>").replace("</h2>", "</h3>")


def _head(run: Run, results: dict[str, Any], other: Run | None) -> Iterator[str]:
    zone = results["zone"]
    first, last = (times.text(times.utc(run, float(run.times[i])), zone) for i in (0, -1))
    names = ", ".join(results["against"])
    yield f"<h1>{quote(run.name)}</h1>"
    yield f'<p class="soft">{first} to {last} &middot; against {quote(names or "reported areas")}</p>'
    made_up = [made.name for made in (run, other) if made is not None and made.synthetic]
    if made_up:
        who = "Both runs are" if len(made_up) > 1 else f"{quote(made_up[0])} is"
        yield (
            f'<p class="warn"><b>{"This run is" if run.synthetic and not other else who} synthetic:</b> '
            "not the output of a fire model. Scores show that the tools work; they say nothing about the "
            "forecasts of a model.</p>"
        )


def _uses(results: dict[str, Any]) -> Iterator[str]:
    if not results["uses"]:
        return
    yield "<h2>Observations</h2>"
    if none := used.nothing(results["uses"]):
        yield f'<p class="warn">{quote(none[:1].upper() + none[1:])}.</p>'
    yield (
        '<p class="soft">Used: in the run\'s grid, from its first time to its last. Before, after: in the '
        "grid at other times. Outside: not in the grid.</p>"
    )
    rows = (
        [quote(row["source"]), row["kind"], *(f"{row[fate]:,}" for fate in used.FATES)]
        for row in results["uses"]
    )
    yield _table(("file", "what", *used.FATES), rows, text=("what",))


def _growth(run: Run, results: dict[str, Any], other: Run | None) -> Iterator[str]:
    yield f"<h2>Growth</h2><figure>{plots.growth(run, results, other)}</figure>"


def _maps(run: Run, grid: ScoreGrid, results: dict[str, Any], seen: Any, other: Run | None) -> Iterator[str]:
    if not results["dates"]:
        return
    yield f"<h2>{'Where the two burned' if other else 'Hits, misses and false alarms'}</h2>"
    yield _key(
        *zip((plots.HITS, plots.FALSE_ALARMS, plots.MISSES), _kinds(run, other), strict=True),
    )
    theirs = None if other is None else (other, ScoreGrid.from_run(other))
    pairs = [_pair(run, grid, row, seen, theirs) for row in results["dates"]]
    frame = shapes.collected([shape for pair in pairs for shape in pair])
    yield '<div class="maps">'
    for row, (here, there) in zip(results["dates"], pairs, strict=True):
        scores = row["all"]["polygons"]
        yield (
            f'<figure><img alt="map" src="{plots.overlap(run, grid, here, there, frame)}">'
            f"<figcaption><b>{local(row['time'], results['zone'])}</b><br>"
            f"Sorensen {_number(scores['sorensen'])}, area {_signed(scores['area_bias'])}"
            f"{'' if other else ', ' + quote(row['source'])}</figcaption></figure>"
        )
    yield "</div>"


def _kinds(run: Run, other: Run | None) -> tuple[str, str, str]:
    """Build the legend of map colours; a comparison of two runs has neither hits nor misses."""
    if other is None:
        return "burned in both: hits", "burned in this run alone: false alarms", "seen burned alone: misses"
    return "burned in both", f"only in {quote(run.name)}", f"only in {quote(other.name)}"


def _pair(
    run: Run, grid: ScoreGrid, row: dict[str, Any], seen: Any, theirs: tuple[Run, ScoreGrid] | None
) -> tuple[Any, Any]:
    """Project the shapes of a date: the run's, and the observed one or the other run's."""
    moment = datetime.fromisoformat(row["time"])
    here = grid.polygon(times.seconds(run, moment))
    if theirs is not None:
        other, there = theirs
        shape = there.polygon(times.seconds(other, moment))
        return here, grid.projection.project(there.degrees(shape))
    for perimeter in seen.perimeters:
        if abs((perimeter.time - moment).total_seconds()) < 1.0 and perimeter.source == row["source"]:
            return here, grid.projection.project(shapes.of_perimeter(perimeter, grid.middle))
    raise KeyError(row["time"])


def _scores(results: dict[str, Any], area: Measure = ACRES, distance: Measure = METRES) -> Iterator[str]:
    for key, title, text in (
        ("all", "Scores", "All that had burned by each date."),
        (
            "without_start",
            "Scores without the start",
            "Area burned before the start of the run is excluded.",
        ),
    ):
        rows = [row for row in results["dates"] if key in row]
        if not rows:
            continue
        yield f'<h2>{title}</h2><p class="soft">{text} Small: difference between polygons and cells.</p>'
        sizes = f"run, {area.name}", f"{theirs(results)}, {area.name}"
        head = ("date", *sizes, *_SHOWN, f"apart, {distance.name}")
        yield _table(head, (_score_row(row, row[key], results["zone"], area, distance) for row in rows))
    if results["dates"] and results["other_run"]:
        yield (
            '<p class="soft">Hits burned in both, false alarms in this run alone, misses in the other alone: '
            "between two runs none of it is right or wrong.</p>"
        )
    if results["dates"]:
        yield "<dl>" + "".join(f"<dt>{n}</dt><dd>{quote(text)}</dd>" for n, text in _HELP.items()) + "</dl>"


def _score_row(
    row: dict[str, Any], scores: dict[str, Any], zone: str, area: Measure, distance: Measure
) -> list[str]:
    polygons, error = scores["polygons"], scores["error"]
    sizes = [_area(polygons[name], error[name], area) for name in ("area", "observed_area")]
    numbers = [f"{_number(polygons[name])}<small>&plusmn; {_number(error[name])}</small>" for name in _SHOWN]
    mean, most = (row["distance"][name] for name in ("mean", "hausdorff"))
    apart = "-" if mean is None else f"{distance.format(mean)}<small>most {distance.format(most)}</small>"
    return [local(row["time"], zone), *sizes, *numbers, apart]


def _reported(run: Run, grid: ScoreGrid, results: dict[str, Any]) -> Iterator[str]:
    rows = [row for row in results["reported"] if row["run"] is not None]
    if not rows:
        return
    yield "<h2>Reported areas</h2>"
    yield (
        '<p class="soft">What agencies and newspapers printed at the time: how much had burned, not where. '
        "An area alone is right for a fire in the wrong place too. Small: polygons against cells.</p>"
    )
    yield _table(
        ("date", "run, acres", "reported, acres", "difference", "source"),
        (
            [
                local(row["time"], results["zone"]),
                _area(row["run"], abs(row["polygons"] - row["run"])),
                ACRES.format(row["reported"]),
                _signed(row["difference"]),
                quote(row["source"]) + (f"<small>{quote(row['note'])}</small>" if row["note"] else ""),
            ]
            for row in rows
        ),
        text=("source",),
    )
    moments = [datetime.fromisoformat(row["time"]) for row in rows]
    fires = [grid.polygon(times.seconds(run, moment)) for moment in moments]
    labels = [f"by {times.text(moment, results['zone'])}" for moment in moments]
    yield "<h2>Where the run burned by these dates</h2>"
    yield _key(*zip(plots.ways(len(fires)), labels, strict=True))
    picture = plots.progress(run, grid, fires, shapes.collected(fires))
    yield f'<figure class="one"><img alt="map" src="{picture}"></figure>'


def _more(results: dict[str, Any]) -> Iterator[str]:
    if results["arrival"]:
        yield f"<h2>Arrival times</h2><p>{quote(arrival(results))}.</p>"
    if results["detections"]:
        yield "<h2>Detections by satellites</h2>"
        yield (
            '<p class="soft">Inside: the run had burned there by then. Lag: how long before the overpass the '
            "front had passed, negative where it came later.</p>"
        )
        yield _table(
            ("overpass", "seen", "inside", "within a pixel", "never burned", "median lag"),
            (
                [
                    local(row["time"], results["zone"]),
                    *(f"{row[name]:,}" for name in ("count", "inside", "within_pixel", "never")),
                    "-" if row["lag_median"] is None else f"{row['lag_median'] / 3600:+.1f} h",
                ]
                for row in results["detections"]
            ),
        )


def _foot(results: dict[str, Any]) -> Iterator[str]:
    wide, high = results["domain"]["cell"]
    notes = [
        *said(results),
        f"cells of {high:.0f} x {wide:.0f} m; "
        f"kappa's domain is all {results['domain']['area'] / 1e6:,.0f} km2",
        f"polygons in {results['projection']}",
        "scores as in Duff, Chong and Tolhurst, Environmental Modelling & Software 83 (2016)",
    ]
    yield "<h2>To know</h2><ul>" + "".join(f"<li>{quote(note)}</li>" for note in notes) + "</ul>"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], text: Sequence[str] = ()) -> str:
    kinds = [' class="text"' if name in text else "" for name in head]
    top = "".join(f"<th{kind}>{name}</th>" for kind, name in zip(kinds, head, strict=True))
    inside = "".join(
        "<tr>" + "".join(f"<td{kind}>{cell}</td>" for kind, cell in zip(kinds, row, strict=True)) + "</tr>\n"
        for row in rows
    )
    return f'<div class="wide"><table><thead><tr>{top}</tr></thead><tbody>\n{inside}</tbody></table></div>'


def _key(*colours: tuple[str, str]) -> str:
    inside = "".join(f'<span><i style="background:{colour}"></i>{text}</span>' for colour, text in colours)
    return f'<div class="key">{inside}</div>'


def _area(value: float, error: float, unit: Measure = ACRES) -> str:
    return f"{unit.format(value)}<small>&plusmn; {unit.format(error)}</small>"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _signed(value: float | None) -> str:
    return "-" if value is None else f"{round(100 * value, 1) + 0.0:+.1f} %"
