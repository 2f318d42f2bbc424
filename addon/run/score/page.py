"""Scores as text for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from typing import Any

from ...data import history
from ...escaped import escaped
from .. import times
from . import used

ACRE = history.SQUARE_METRES_PER_ACRE

Column = tuple[str, int, Callable[[Any], str]]

_ALL: tuple[Column, ...] = (
    ("area", 9, lambda v: f"{v / ACRE:,.0f}"),
    ("observed_area", 9, lambda v: f"{v / ACRE:,.0f}"),
    ("area_bias", 9, lambda v: f"{100 * v:+.1f} %"),
    *((name, 10, lambda v: f"{v:.3f}") for name in ("sorensen", "jaccard", "kappa", "precision", "recall")),
    *((name, 8, lambda v: f"{v:.3f}") for name in ("sdi", "adi")),
)
_TITLES = {"area": "run", "area_bias": "bias"}


def page(results: dict[str, Any]) -> str:
    """Format the page that `firetwin score` prints."""
    run = results["run"]
    head = run["name"] + ("  (SYNTHETIC: not the output of a model)" if run["synthetic"] else "")
    lines = [
        head,
        *against(results),
        *_uses(results),
        *_dates(results),
        *_distances(results),
        *_more(results),
    ]
    return "\n".join(map(escaped, lines))


def against(results: dict[str, Any]) -> list[str]:
    """Describe the reference data and the domain of the scores."""
    wide, high = results["domain"]["cell"]
    ny, nx = results["domain"]["cells"]
    names = ", ".join(results["against"]) or "reported areas alone: no perimeters or detections were given"
    domain = f"domain of kappa {results['domain']['area'] / 1e6:,.0f} km2"
    return [f"against {names}", f"{ny} x {nx} cells of {high:.0f} x {wide:.0f} m, {domain}"]


def _uses(results: dict[str, Any]) -> Iterator[str]:
    """Format the table of observations used per file, with the reasons for exclusion."""
    if not results["uses"]:
        return
    wide = max(24, *(len(_name(row)) for row in results["uses"]))
    yield from ("", f"{'Observations':<{wide + 2}}" + "".join(f"{fate:>9}" for fate in used.FATES))
    for row in results["uses"]:
        yield f"  {_name(row):<{wide}}" + "".join(f"{row[fate]:>9,}" for fate in used.FATES)
    if none := used.nothing(results["uses"]):
        yield none


def _name(row: dict[str, Any]) -> str:
    return f"{row['source']}, {row['kind']}"


def _dates(results: dict[str, Any]) -> Iterator[str]:
    for key, title in (
        ("all", "All that had burned"),
        ("without_start", "Without the run's start"),
    ):
        rows = [row for row in results["dates"] if key in row]
        if not rows:
            continue
        yield ""
        titles = _TITLES | {"observed_area": theirs(results)}
        yield f"{title:<26}" + "".join(f"{titles.get(name, name):>{w}}" for name, w, _ in _ALL)
        for row in rows:
            yield f"  {local(row['time'], results['zone']):<24}" + _cells(row[key]["polygons"])
            yield f"  {'  +-, polygons or cells':<24}" + _cells(row[key]["error"])


def _cells(scores: dict[str, float | None]) -> str:
    return "".join(f"{'-' if scores[n] is None else form(scores[n]):>{w}}" for n, w, form in _ALL)


def _distances(results: dict[str, Any]) -> Iterator[str]:
    if results["dates"]:
        yield ""
        yield f"{'Perimeters apart, m':<26}{'mean':>10}{'Hausdorff':>10}"
    for row in results["dates"]:
        far = [row["distance"][name] for name in ("mean", "hausdorff")]
        yield f"  {local(row['time'], results['zone']):<24}" + "".join(
            f"{'-' if distance is None else format(distance, ',.0f'):>10}" for distance in far
        )


def _more(results: dict[str, Any]) -> Iterator[str]:
    if results["arrival"]:
        yield from ("", arrival(results))
    if results["detections"]:
        yield ""
        yield f"{'Detections':<26}{'seen':>8}{'inside':>8}{'in a pixel':>12}{'never':>8}{'median lag':>12}"
    for row in results["detections"]:
        lag = "-" if row["lag_median"] is None else f"{row['lag_median'] / 3600:+.1f} h"
        yield (
            f"  {local(row['time'], results['zone']):<24}{row['count']:>8}{row['inside']:>8}"
            f"{row['within_pixel']:>12}{row['never']:>8}{lag:>12}"
        )
    covered = [row for row in results["reported"] if row["run"] is not None]
    if covered:
        yield ""
        yield f"{'Burned area, acres':<26}{'run':>10}{'+-':>8}{'reported':>10}{'difference':>12}  source"
    for row in covered:
        apart = abs(row["polygons"] - row["run"]) / ACRE
        share = round(100 * row["difference"], 1) + 0.0  # no "-0.0"
        yield (
            f"  {local(row['time'], results['zone']):<24}{row['run'] / ACRE:>10,.0f}{apart:>8,.0f}"
            f"{row['reported'] / ACRE:>10,.0f}{share:>+10.1f} %  {row['source']}"
        )
    notes = said(results)
    yield from ["", "To know", *(f"  - {text}" for text in notes)] if notes else []


def theirs(results: dict[str, Any]) -> str:
    """Choose the column title for reference areas: another run is not an observation."""
    return "other" if results["other_run"] else "seen"


def arrival(scores: dict[str, Any]) -> str:
    """Format arrival time errors in one line."""
    errors, alone = scores["arrival"], "in the other" if scores["other_run"] else "seen"
    if not errors["cells"]:
        return "Arrival times: no cell burned in both"
    bias, mae, rmse = (errors[name] / 3600 for name in ("bias", "mae", "rmse"))
    return (
        f"Arrival times of {errors['cells']:,} cells ({errors['observed']}): bias {bias:+.2f} h, "
        f"mean absolute error {mae:.2f} h, RMSE {rmse:.2f} h; "
        f"burned in the run alone {errors['run_only']:,}, {alone} alone {errors['seen_only']:,}"
    )


def said(results: dict[str, Any]) -> Sequence[str]:
    """List notes on these scores."""
    notes = list(results["assumptions"])
    outside = [row["outside_grid"] for row in results["dates"] if row["outside_grid"] > 1e-3]
    if outside:
        notes.append(
            f"up to {100 * max(outside):.1f} % of an observed perimeter lie outside of the run's grid"
        )
    if results["arrival_from"] == "heat_flux":
        notes.append("the run has no fuel_arrival_time: its front is estimated from heat fluxes")
    if results["burned_from"] == "burned_fraction":
        notes.append("areas on cells are sums of the burned fraction of each cell, as the model gives it")
    if results["reported"] and not results["dates"]:
        notes.append("reported areas say how much had burned, not where: no overlap can be scored by them")
    if results["reported"] and results["run"]["synthetic"]:
        notes.append(
            "the synthetic run was tuned to the reported areas: their agreement proves nothing of a model"
        )
    return notes


def local(time: str, zone: str) -> str:
    """Format the local time of a scored date."""
    return times.text(datetime.fromisoformat(time), zone)
