"""Summary of an ensemble, as data (for programs) and as a page of text (for people)."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...escaped import escaped
from ...run import times
from .choice import choose
from .ensemble import Ensemble
from .manifest import KINDS

_HECTARE = 1e4  # m2


def gather(ensemble: Ensemble) -> dict[str, Any]:
    """Gather the facts that `firetwin info` shows of an ensemble: s, m2."""
    chosen = choose(ensemble)
    return {
        "name": ensemble.manifest.name,
        "path": str(ensemble.path),
        "kind": ensemble.manifest.kind,
        "synthetic": ensemble.manifest.synthetic,
        "model": ensemble.manifest.model,
        "source": ensemble.manifest.source,
        "issued": times.iso(ensemble.issued),
        "horizon": ensemble.horizon,
        "cells": [len(ensemble.latitude), len(ensemble.longitude)],
        "perturbed": ensemble.manifest.perturbed,
        "not_perturbed": ensemble.manifest.not_perturbed,
        "members": [
            {
                "name": member.name,
                "weight": member.weight,
                "end": float(min(member.end, ensemble.horizon)),
                "area": _number(chosen.area[index]),
                "depth": _number(chosen.depth[index]),
            }
            for index, member in enumerate(ensemble.members)
        ],
        "left_out": [{"name": each.name, "reason": each.reason} for each in ensemble.left_out],
        "choice": {
            role: ensemble.members[getattr(chosen, role)].name
            for role in ("typical", "smallest", "largest", "outlier")
        },
    }


def page(facts: dict[str, Any]) -> str:
    """Format the facts for people."""
    members, left_out = facts["members"], facts["left_out"]
    areas = sorted(each["area"] for each in members if each["area"] is not None)
    area = {each["name"]: each["area"] for each in members}
    total = len(members) + len(left_out)
    lines = [
        f"{facts['name']}{' (synthetic)' if facts['synthetic'] else ''}",
        f"kind        {facts['kind']}: {KINDS[facts['kind']]}",
        f"model       {facts['model'] or 'not given'}; {facts['source'] or 'source not given'}",
        f"issued      {facts['issued']}, to {facts['horizon'] / 3600.0:.4g} h",
        f"grid        {facts['cells'][0]} x {facts['cells'][1]} cells",
        f"members     {len(members)} of {total}",
        f"perturbed   {facts['perturbed'] or 'not given'}",
        f"the same    {facts['not_perturbed'] or 'not given'}",
        f"burned      {_hectares(areas[0])} to {_hectares(areas[-1])} at the end of the forecast",
    ]
    for role in ("typical", "smallest", "largest", "outlier"):
        name = facts["choice"][role]
        lines.append(f"{role:<12}{name}, {_hectares(area[name])}")
    lines += [f"left out    {each['name']}: {each['reason']}" for each in left_out]
    return "\n".join(escaped(line) for line in lines)


def _hectares(area: float) -> str:
    return f"{area / _HECTARE:,.0f} ha"


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
