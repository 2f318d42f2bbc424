"""Run summary, as data (for programs) and as a page of text (for people)."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..data import history
from ..errors import input_error
from ..escaped import escaped
from ..files import read_text
from . import (
    areas,
    blocks,
    burned_by_heat,
    burned_fraction,
    fact_cache,
    fuel_category,
    released,
    run_warnings,
    times,
)

ACRE = history.SQUARE_METRES_PER_ACRE


def gather(run: Run, zone: str) -> dict[str, Any]:
    """Gather the facts that `firetwin info` shows: m, m2, W and J.

    Results are cached in the run's folder.
    """
    facts = fact_cache.facts(run, zone, lambda: _find(run, zone))
    return facts | {"path": run.path, "source": source(Path(run.path))}


def source(folder: Path) -> dict[str, Any]:
    """Read the provenance from run.toml: model, version, projection, files and assumptions.

    Raises
    ------
    InputError
        A value has another type than `convert` writes.
    """
    path = folder / "run.toml"
    try:
        entries = tomllib.loads(read_text(path, "utf-8-sig")).get("source", {})
    except (OSError, ValueError, RecursionError):  # `description` reports these
        return {}
    for key, value in entries.items():
        listed = isinstance(value, list) and all(isinstance(each, str) for each in value)
        if key == "assumptions" and not listed:
            raise input_error(path, 'source.assumptions is not a list of texts; write ["..."], or remove it')
        if key == "model" and not isinstance(value, str):
            raise input_error(path, "source.model is not a text; write it in quotes, or remove it")
    return entries


def _find(run: Run, zone: str) -> dict[str, Any]:
    reports = _reports(run)
    at = [float(run.times[0]), float(run.times[-1]), *(times.seconds(run, report.time) for report in reports)]
    first, last, *then = burned(run, at)
    low, high = run.flux_range()
    seconds, heat, fuel = run.times, released.energy(run), released.of_fuel(run)
    return {
        "name": run.name,
        "path": run.path,
        "synthetic": run.synthetic,
        "event": run.event,
        "zone": zone,
        "grid": _grid(run.latitude, run.longitude)
        | {"elevation": _range(run.elevation), "vertical": run.vertical},
        "fuel_grid": _grid(run.fuel_latitude, run.fuel_longitude),
        "surface_fuel": _fuel(run, "surface_fuel", 0.0),
        "canopy_fuel": _fuel(run, "canopy_fuel", 0.01),
        "fuel_category": fuel_category.shares(run),
        "times": {
            "count": len(seconds),
            "first": times.iso(times.utc(run, float(seconds[0]))),
            "last": times.iso(times.utc(run, float(seconds[-1]))),
            "interval": _range(np.diff(seconds)) if len(seconds) > 1 else None,
        },
        "fields": list(run.fields),
        "heat_flux": {"min": low, "max": high},
        "energy": heat,
        "fuel_energy": fuel,
        "burned": {
            "from": burned_from(run),
            "first": first,
            "last": last,
        },
        "reported": _reported(run, reports, then),
        "warnings": [*run_warnings.texts(run), *released.warnings(heat, fuel)],
    }


def burned(run: Run, moments: Sequence[float] | NDArray[np.float64]) -> list[float]:
    """Compute the burned area (m2) at model times (s).

    It is the sum of burned fractions if the run has them (`burned_fraction`), linear between its times; else
    the area of fuel cells whose centre the fire has reached. Without the run's own arrival times, each cell
    of the model grid counts by its burned fraction, from its heat (`burned_by_heat`). If fluxes are too
    uneven for it, fuel cells count whose centre the front has reached, as estimated from heat fluxes.
    """
    strip, width = areas.area_factors(run.fuel_latitude, run.fuel_longitude)
    if run.has(burned_fraction.FIELD):
        return burned_fraction.areas(run, moments, strip, width)
    if not run.has("fuel_arrival_time") and (by_heat := burned_by_heat.areas(run)) is not None:
        return np.interp(moments, run.times, by_heat, left=0.0).tolist()
    arrival = blocks.arrival(run)
    order = np.argsort(moments)
    ordered = np.asarray(moments, np.float64)[order]
    since = np.zeros(len(ordered) + 1)  # by the first time that is not earlier
    for first, end in blocks.rows(run):
        time = arrival(first, end)
        row, column = np.divmod(np.flatnonzero(time <= ordered[-1]), time.shape[1])
        index = np.searchsorted(ordered, time[row, column].astype(np.float64))
        since += np.bincount(index, strip[first + row] * width[column], len(since))
    areas_then = np.empty(len(ordered))
    areas_then[order] = np.cumsum(since[:-1])
    return areas_then.tolist()


def burned_from(run: Run) -> str:
    """Name the field from which burned areas are computed."""
    known = (burned_fraction.FIELD, "fuel_arrival_time")
    return next((name for name in known if run.has(name)), "heat_flux")


def reported(run: Run) -> list[dict[str, Any]]:
    """List reported acreages (m2) of the real fire, with the areas of the run."""
    if not (reports := _reports(run)):
        return []
    return _reported(run, reports, burned(run, [times.seconds(run, report.time) for report in reports]))


def _grid(latitude: np.ndarray, longitude: np.ndarray) -> dict[str, Any]:
    dx, dy = areas.cell_size(latitude, longitude)
    return {
        "shape": [len(latitude), len(longitude)],
        "latitude": [float(min(latitude)), float(max(latitude))],
        "longitude": [float(min(longitude)), float(max(longitude))],
        "spacing": [dx, dy],
        "extent": [dx * len(longitude), dy * len(latitude)],
    }


def _range(values: np.ndarray) -> dict[str, float]:
    return {"min": float(np.nanmin(values)), "max": float(np.nanmax(values))}


def _fuel(run: Run, field: str, above: float) -> dict[str, float]:
    """Compute the fraction of the finite values above a threshold, with their mean and range."""
    count, more, total, low, high = 0, 0, 0.0, np.inf, -np.inf
    for first, end in blocks.rows(run):
        finite = run.fuel_rows(field, first, end)
        known = np.isfinite(finite)
        finite = finite if known.all() else finite[known]
        if finite.size:
            count, more = count + finite.size, more + int(np.count_nonzero(finite > above))
            total += float(finite.sum(dtype=np.float64))
            low, high = min(low, float(finite.min())), max(high, float(finite.max()))
    if count == 0:
        return {"above": above, "share": 0.0, "mean": 0.0, "min": 0.0, "max": 0.0}
    return {"above": above, "share": more / count, "mean": total / count, "min": low, "max": high}


def _reports(run: Run) -> list[history.Acreage]:
    """List reported acreages of the real fire."""
    return list(history.load(run.event).acreages) if run.event and run.event in history.events() else []


def _reported(run: Run, reports: list[history.Acreage], areas_then: list[float]) -> list[dict[str, Any]]:
    """List reported acreages with the areas of the run (m2) at their times, if the run covers them."""
    rows = []
    for report, area in zip(reports, areas_then, strict=True):
        row = {"time": times.iso(report.time), "reported": report.acres * ACRE, "source": report.source}
        row["note"] = report.note
        covered = run.times[0] <= times.seconds(run, report.time) <= run.times[-1]
        row["run"] = area if covered else None
        row["difference"] = area / row["reported"] - 1 if covered else None
        rows.append(row)
    return rows


def page(info: dict[str, Any]) -> str:
    """Format the page that `firetwin info` prints."""
    return "\n".join(
        escaped(line)
        for line in [
            info["name"] + ("  (SYNTHETIC: not the output of a model)" if info["synthetic"] else ""),
            info["path"],
            "",
            *_rows(_facts(info)),
            *_acreages(info),
            *_made_of(info.get("source", {})),
            *(["", "Warnings", *(f"  - {text}" for text in info["warnings"])] if info["warnings"] else []),
        ]
    )


def _made_of(source: dict[str, Any]) -> list[str]:
    if not source:
        return []
    return [
        "",
        f"Made from {source['model']}" if "model" in source else "Assumptions",
        *(f"  - {text}" for text in source.get("assumptions", [])),
    ]


def format_area(square_metres: float, unit: str) -> str:
    """Format an area in ``acres`` or ``ha``, without the unit."""
    return f"{square_metres / (ACRE if unit == 'acres' else 1.0e4):,.0f}"


def brief(info: dict[str, Any], area_unit: str = "acres") -> list[tuple[str, str]]:
    """List key facts for a narrow panel: labels and texts. Areas are in ``acres`` or ``ha``."""
    grid, fuel, when = info["grid"], info["fuel_grid"], info["times"]
    burned = [format_area(info["burned"][key], area_unit) for key in ("first", "last")]
    return [
        *([("Kind", "synthetic")] if info["synthetic"] else []),
        ("Grid", _cells(grid)),
        ("Fuels", _cells(fuel)),
        ("Extent", f"{grid['extent'][1] / 1e3:.1f} x {grid['extent'][0] / 1e3:.1f} km"),
        ("Heights", f"{grid['elevation']['min']:,.0f} to {grid['elevation']['max']:,.0f} m"),
        ("Times", f"{when['count']:,}{_interval(when)}"),
        *(
            (label, times.text(datetime.fromisoformat(when[key]), info["zone"]))
            for label, key in (("First", "first"), ("Last", "last"))
        ),
        ("Burned", f"{burned[0]} to {burned[1]} {area_unit}"),
        ("Heat flux", f"up to {info['heat_flux']['max'] / 1e3:,.4g} kW/m²"),
    ]


def _cells(grid: dict[str, Any]) -> str:
    (ny, nx), (dx, dy) = grid["shape"], grid["spacing"]
    return f"{ny} x {nx} cells of {(dx * dy) ** 0.5:.0f} m"


def _interval(when: dict[str, Any]) -> str:
    """Format the interval between the times."""
    if when["interval"] is None:
        return ""
    least, most = when["interval"]["min"], when["interval"]["max"]
    return f", every {least:g} s" if most - least < 1e-6 else f", {least:g} to {most:g} s apart"


def _facts(info: dict[str, Any]) -> list[tuple[str, str]]:
    grid, fuel, when = info["grid"], info["fuel_grid"], info["times"]
    zone, height = info["zone"], grid["elevation"]
    first, last = (datetime.fromisoformat(when[key]) for key in ("first", "last"))
    facts = [
        ("Model grid", _size(grid)),
        ("", _span(grid["latitude"], "N", "S") + ", " + _span(grid["longitude"], "E", "W")),
        (
            "",
            f"elevation {height['min']:,.0f} to {height['max']:,.0f} m ({grid['vertical']})",
        ),
        ("Fuel grid", _size(fuel)),
        ("Surface fuel", _load(info["surface_fuel"])),
        ("Canopy fuel", _load(info["canopy_fuel"])),
        *([("Fuel models", _shares(info["fuel_category"]))] if info["fuel_category"] else []),
        ("Times", f"{when['count']:,}{_interval(when)}"),
        ("  first", f"{times.text(first, zone)}  ({first:%d %b %H:%M} UTC)"),
        ("  last", f"{times.text(last, zone)}  ({last:%d %b %H:%M} UTC)"),
        (
            "Heat flux",
            f"{info['heat_flux']['min'] / 1e3:,.4g} to {info['heat_flux']['max'] / 1e3:,.4g} kW/m2",
        ),
        ("Heat released", _released(info["energy"], info["fuel_energy"])),
        ("Burned at first", _area(info["burned"]["first"])),
        ("Burned at last", _area(info["burned"]["last"])),
        *([("", _areas_from(info))] if info["burned"]["from"] != "fuel_arrival_time" else []),
        ("Fields", ", ".join(info["fields"])),
    ]
    return facts


def _areas_from(info: dict[str, Any]) -> str:
    """Note on how burned areas are computed, if not from whole fuel cells."""
    if info["burned"]["from"] == "burned_fraction":
        return "sums of the burned fraction of each cell, as the model gives it"
    grid = info["grid"]
    dx, dy = grid["spacing"]
    return f"estimated: the run has no fuel_arrival_time, only fluxes of {(dx * dy) ** 0.5:.0f} m cells"


def _acreages(info: dict[str, Any]) -> list[str]:
    rows = [row for row in info["reported"] if row["run"] is not None]
    if not info["reported"]:
        return []
    lines = ["", f"{'Burned area, acres':<26}{'this run':>10}{'reported':>10}{'difference':>12}  source"]
    for row in rows:
        when = times.text(datetime.fromisoformat(row["time"]), info["zone"])
        lines.append(
            f"  {when:<24}{row['run'] / ACRE:>10,.0f}{row['reported'] / ACRE:>10,.0f}"
            f"{round(row['difference'] * 100, 1) + 0.0:>+10.1f} %  {row['source']}"
        )
    outside = len(info["reported"]) - len(rows)
    if outside:
        lines.append(f"  {outside} more reports are of times before or after this run")
    return lines


def _rows(facts: list[tuple[str, str]]) -> list[str]:
    return [f"{label:<17}{text}".rstrip() for label, text in facts]


def _size(grid: dict[str, Any]) -> str:
    (ny, nx), (dx, dy), (width, height) = grid["shape"], grid["spacing"], grid["extent"]
    cells = f"{ny} x {nx} cells of {dy:.1f} x {dx:.1f} m (north x east)"
    return f"{cells}, {height / 1e3:.1f} x {width / 1e3:.1f} km"


def _span(bounds: list[float], positive: str, negative: str) -> str:
    places = [float(areas.turned(bound, 0.0)) for bound in bounds]
    letters = [positive if place >= 0 else negative for place in places]
    first = "" if letters[0] == letters[1] else f" {letters[0]}"
    return f"{abs(places[0]):.4f}{first} to {abs(places[1]):.4f} {letters[1]}"


def _load(fuel: dict[str, float]) -> str:
    return (
        f"above {fuel['above']:g} in {fuel['share'] * 100:.1f} % of cells, "
        f"mean {fuel['mean']:.2f}, at most {fuel['max']:.2f} kg/m2"
    )


def _shares(parts: dict[str, float]) -> str:
    return ", ".join(f"{name} {part * 100:.0f} %" for name, part in parts.items() if part >= 0.005)


def _energy(joules: float) -> str:
    for factor, unit in ((1e15, "PJ"), (1e12, "TJ"), (1e9, "GJ")):
        if joules >= factor:
            return f"{joules / factor:,.4g} {unit}"
    return f"{joules:,.4g} J"


def _released(heat: float, fuel: float) -> str:
    beside = f"  ({heat / fuel:,.2f} times the heat of the fuel burned)" if fuel > 0.0 else ""
    return _energy(heat) + beside


def _area(square_metres: float) -> str:
    return f"{square_metres / ACRE:,.0f} acres ({square_metres / 1e4:,.0f} ha)"
