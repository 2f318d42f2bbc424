"""Scores of an ensemble against observed perimeters: `firetwin score ENSEMBLE`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from ..geometry.grids import within
from ..run import times
from ..run.arrival_grid import ArrivalGrid
from ..run.observations import Observations
from ..run.score import shapes
from ..run.score.grid import ScoreGrid
from . import probability
from .ensemble.ensemble import Ensemble
from .ensemble.manifest import KINDS
from .ensemble.statistics import depths

MARGIN = 2000.0  # m around all members and perimeters: cells beyond count as agreement of no interest
WINDOWS = 1, 3, 5, 9, 17, 33  # cells
_DOMAIN = "cells with their centre within the margin of the centre of a burned cell, simulated by all members"
_EDGE = "windows lie inside the grid of the ensemble"


def score(ensemble: Ensemble, observations: Observations, zone: str = "UTC") -> dict[str, Any]:
    """Compute the scores of an ensemble as JSON data: m, m2, s, and fractions from 0 to 1.

    Scores use the members that reach the horizon, with equal weights, in the cells within MARGIN of any
    member's or perimeter's area.

    Raises
    ------
    UsageError
        Shapely or pyproj is missing.
    Error
        The ensemble is not a forecast of one fire, or no perimeter is within its times.
    """
    shapes.needed()
    if ensemble.manifest.kind != "forecast":
        raise Error(
            f"{ensemble.path}: holds {KINDS[ensemble.manifest.kind]}; scores of probabilities need a forecast"
        )
    grid = ScoreGrid(ensemble.latitude, ensemble.longitude, np.empty(ensemble.shape[1:]))
    moments, masks, used = _observed(ensemble, observations, grid)
    counted = ensemble.counted(ensemble.horizon)
    arrival = np.stack([ensemble.arrival(int(index)) for index in np.flatnonzero(counted)])
    domain = _domain(arrival, masks, grid)
    deepest = int(np.nanargmax(depths(ensemble, ensemble.horizon)[counted]))
    names = [member.name for member, each in zip(ensemble.members, counted, strict=True) if each]
    return {
        "ensemble": {
            "name": ensemble.manifest.name,
            "path": str(ensemble.path),
            "synthetic": ensemble.manifest.synthetic,
            "issued": times.iso(ensemble.issued),
            "horizon": ensemble.horizon,
            "members": len(names),
            "of": len(ensemble.members) + len(ensemble.left_out),
            "deepest": names[deepest],
        },
        "against": used,
        "zone": zone,
        "domain": {
            "area": float(grid.areas[domain].sum()),
            "cells": int(domain.sum()),
            "margin": MARGIN,
            "rule": _DOMAIN,
            "cell": list(grid.cell),
        },
        "fss": {"rule": _EDGE, "outside": "cells that a member did not simulate count as unburned"},
        "arrival": _arrival(arrival, masks, moments, domain, grid),
        "dates": [
            _date(ensemble, arrival, mask, moment, domain, grid, names, deepest)
            for moment, mask in zip(moments, masks, strict=True)
        ],
        "assumptions": list(observations.assumptions),
    }


def _observed(
    ensemble: Ensemble, observations: Observations, grid: ScoreGrid
) -> tuple[list[float], list[NDArray[np.bool_]], list[dict[str, Any]]]:
    """Return times (s since the issue time) and masks of perimeters in the forecast, and all uses."""
    moments, masks, used = [], [], []
    for perimeter in observations.perimeters:
        time = (perimeter.time - ensemble.issued).total_seconds()
        mask = grid.inside(shapes.of_perimeter(perimeter, grid.middle))
        use = "used"
        if not 0.0 < time <= ensemble.horizon:
            use = "before the forecast" if time <= 0.0 else "after the forecast"
        elif not mask.any():
            use = "outside of the grid"
        else:
            moments.append(time)
            masks.append(mask)
        used.append({"source": perimeter.source, "time": times.iso(perimeter.time), "use": use})
    if not moments:
        raise Error(
            f"{ensemble.path}: no perimeter is within its grid and its {ensemble.horizon / 3600.0:.4g} h "
            f"from {times.iso(ensemble.issued)}; give perimeters of this time"
        )
    return moments, masks, used


def _domain(arrival: NDArray, masks: Sequence[NDArray[np.bool_]], grid: ArrivalGrid) -> NDArray[np.bool_]:
    """Mask the cells of the domain (see `_DOMAIN`)."""
    burned = (arrival < np.inf).any(0) | np.any(masks, axis=0)
    return within(burned, MARGIN, grid.cell) & ~np.isnan(arrival).any(0)


def _arrival(
    arrival: NDArray,
    masks: Sequence[NDArray[np.bool_]],
    moments: Sequence[float],
    domain: NDArray[np.bool_],
    grid: ArrivalGrid,
) -> dict[str, Any]:
    """Score arrival times, censored at the last perimeter: "never" is later than that, for all."""
    end = moments[-1]
    seen = np.full(domain.shape, end)
    for before, moment, mask in reversed(list(zip([0.0, *moments[:-1]], moments, masks, strict=True))):
        seen[mask] = (before + moment) / 2.0
    members = np.clip(arrival[:, domain].astype(np.float64), 0.0, end)
    weight = grid.areas[domain] / grid.areas[domain].sum()
    return {
        "censored_at": end,
        "observed": "middle of the two perimeters between which a cell burned",
        "crps": float((weight * probability.crps(members, seen[domain])).sum()),
        "fair_crps": float((weight * probability.crps(members, seen[domain], fair=True)).sum()),
        "mae_of_median": float((weight * np.abs(np.median(members, 0) - seen[domain])).sum()),
    }


def _date(
    ensemble: Ensemble,
    arrival: NDArray,
    mask: NDArray[np.bool_],
    moment: float,
    domain: NDArray[np.bool_],
    grid: ArrivalGrid,
    names: Sequence[str],
    deepest: int,
) -> dict[str, Any]:
    burned = arrival <= moment
    share = burned.mean(0)
    area = np.einsum("mrc,rc->m", burned, grid.areas)
    observed = float(grid.areas[mask].sum())
    both = np.einsum("mrc,rc->m", burned & mask, grid.areas)
    union = area + observed - both
    jaccard = np.divide(both, union, out=np.ones_like(both), where=union > 0.0)
    order = np.argsort(jaccard, kind="stable")
    weight = grid.areas[domain]
    rank = probability.rank(area, observed)
    return {
        "time": times.iso(ensemble.valid(moment)),
        "lead": moment,
        "observed_area": observed,
        "brier": asdict(probability.brier(share[domain], mask[domain], weight)),
        "reliability": [asdict(row) for row in probability.reliability(share[domain], mask[domain], weight)],
        "fss": [
            {"cells": width, "fss": _number(probability.fss(share, mask.astype(float), width))}
            for width in WINDOWS
        ],
        "area": {
            "mean": float(area.mean()),
            "spread": float(area.std(ddof=1)) if len(area) > 1 else None,
            "error": float(area.mean() - observed),
            "rank": list(rank),
        },
        "jaccard": {
            "best": [names[order[-1]], float(jaccard[order[-1]])],
            "median": float(np.median(jaccard)),
            "worst": [names[order[0]], float(jaccard[order[0]])],
            "deepest": [names[deepest], float(jaccard[deepest])],
        },
    }


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _named(value: Sequence[Any]) -> str:
    name, score = value
    return f"{score:.3f} (member {name})"


def page(results: dict[str, Any]) -> str:
    """Format the scores for people."""
    told, arrival = results["ensemble"], results["arrival"]
    zone = results["zone"]
    issued = times.text(datetime.fromisoformat(told["issued"]), zone)
    lines = [
        f"{told['name']}{' (synthetic)' if told['synthetic'] else ''}",
        f"{told['members']} of {told['of']} members, issued {issued}, to {told['horizon'] / 3600.0:.4g} h",
        f"cells within {results['domain']['margin'] / 1000.0:g} km of any burned area: "
        f"{results['domain']['cells']:,}, {results['domain']['area'] / 1e4:,.0f} ha",
        "",
        f"arrival times, censored at {arrival['censored_at'] / 3600.0:.4g} h "
        f"(observed: {arrival['observed']})",
        f"  CRPS {arrival['crps'] / 60.0:.3g} min, fair CRPS {arrival['fair_crps'] / 60.0:.3g} min, "
        f"mean absolute error of the median {arrival['mae_of_median'] / 60.0:.3g} min",
    ]
    for row in results["dates"]:
        brier, jaccard, area = row["brier"], row["jaccard"], row["area"]
        low, high = area["rank"]
        when = times.text(datetime.fromisoformat(row["time"]), zone)
        spread = "" if area["spread"] is None else f", standard deviation {area['spread'] / 1e4:,.0f} ha"
        place = f"{low} members are smaller" if low == high else f"{low} to {high} members are smaller"
        windows = ", ".join(
            f"{each['fss']:.3f} ({each['cells']})" for each in row["fss"] if each["fss"] is not None
        )
        lines += [
            "",
            f"{when}, {row['lead'] / 3600.0:.4g} h after the issue time",
            f"  burned {row['observed_area'] / 1e4:,.0f} ha; members {area['mean'] / 1e4:,.0f} ha on average"
            f"{spread}; {place}",
            f"  Brier score {brier['score']:.4f} = reliability {brier['reliability']:.4f} - resolution "
            f"{brier['resolution']:.4f} + uncertainty {brier['uncertainty']:.4f}",
            f"  FSS (window in cells; {_EDGE}) {windows}",
            f"  Jaccard: best {_named(jaccard['best'])}, median {jaccard['median']:.3f}, "
            f"worst {_named(jaccard['worst'])}, deepest {_named(jaccard['deepest'])}",
        ]
        lines += [
            f"  burned in {each['probability'] * told['members']:.0f} of {told['members']}: "
            f"observed {each['frequency']:.1%} of {each['cells']:,} cells"
            for each in row["reliability"]
        ]
    lines += [
        f"not used: {each['source']}, {each['time']}: {each['use']}"
        for each in results["against"]
        if each["use"] != "used"
    ]
    return "\n".join(lines)
