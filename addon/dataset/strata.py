"""Strata: run, kind of sample, kind of camera and time of day of each sample, in exact shares.

Samples are assigned one after the other, each to the stratum that keeps the counts of all factors, and of all
pairs of factors, closest to their shares. So the first samples of a plan are a small data set of the same
shares, and the strata do not depend on the number of samples. Ties are broken by the seed.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import hashing
from .plan import POSITIVE, Plan

_BY_NIGHT, _BY_DAY = ("night_lights",), ("low_sun",)  # kinds of sample of one time of day alone
_PAIRS = 0.5  # weight of a pair of factors; a factor alone has 1 (assumed)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stratum:
    """Stratum of a sample; `kind` is "fire" or one of `plan.NEGATIVES`."""

    run: str
    kind: str
    camera: str
    night: bool


class Strata:
    """Strata of the samples of a plan, computed as far as they are requested."""

    def __init__(self, plan: Plan) -> None:
        self._kinds, self._cameras = list(_kinds(plan)), list(_shares(plan.cameras))
        self._runs = [run.name for run in plan.runs]
        self._assigned = _assign(_targets(plan), plan.seed)
        self._known: list[Stratum] = []

    def of(self, index: int) -> Stratum:
        """Return the stratum of a sample; samples are numbered from 1."""
        while len(self._known) < index:
            run, kind, camera, night = next(self._assigned)
            self._known.append(
                Stratum(self._runs[run], self._kinds[kind], self._cameras[camera], bool(night))
            )
        return self._known[index - 1]


def _shares(weights: Mapping[str, float]) -> dict[str, float]:
    """Divide weights by their sum; names without weight are omitted."""
    total = sum(weights.values())
    return {name: weight / total for name, weight in weights.items() if weight > 0.0}


def _kinds(plan: Plan) -> dict[str, float]:
    """Compute the share of each kind of sample."""
    negatives = {name: (1.0 - plan.positives) * share for name, share in _shares(plan.negatives).items()}
    return {name: share for name, share in ({POSITIVE: plan.positives} | negatives).items() if share > 0.0}


def _targets(plan: Plan) -> Array:
    """Compute the share of each stratum (runs, kinds, cameras, 2: day and night)."""
    kinds, cameras = _kinds(plan), _shares(plan.cameras)
    runs = _shares({run.name: run.weight for run in plan.runs})
    run_shares = np.array([runs.get(run.name, 0.0) for run in plan.runs])
    nights = np.array([_night(plan, kinds, name) for name in kinds])
    by_kind = np.array(list(kinds.values()))[:, None] * np.stack([1.0 - nights, nights], axis=1)
    camera_shares = np.array(list(cameras.values()))
    return np.einsum("r,kn,c->rkcn", run_shares, by_kind, camera_shares)


def _night(plan: Plan, kinds: Mapping[str, float], name: str) -> float:
    """Compute the share of a kind's samples at night, so that the share of all is the plan's."""
    if name in _BY_NIGHT + _BY_DAY:
        return float(name in _BY_NIGHT)
    fixed = {each: kinds.get(each, 0.0) for each in _BY_NIGHT + _BY_DAY}
    free = max(1.0 - sum(fixed.values()), 1.0e-9)
    return min(max((plan.night - sum(fixed[each] for each in _BY_NIGHT)) / free, 0.0), 1.0)


def _assign(target: Array, seed: int) -> Iterator[tuple[int, ...]]:
    """Yield the stratum of each sample: indices of the factors."""
    axes = range(target.ndim)
    tables = [((axis,), 1.0) for axis in axes] + [(pair, _PAIRS) for pair in itertools.combinations(axes, 2)]
    wanted = [_marginal(target, kept) for kept, _ in tables]
    counts = [np.zeros_like(share) for share in wanted]
    possible = target > 0.0
    for number in itertools.count(1):
        deficit = sum(
            weight * (number * share - count)
            for (_, weight), share, count in zip(tables, wanted, counts, strict=True)
        )
        best = np.where(possible, deficit, -np.inf)
        ties = np.flatnonzero(best.ravel() >= best.max() - 1.0e-9)
        chosen = np.unravel_index(ties[hashing.integer(seed, number, 0, "stratum") % len(ties)], best.shape)
        for (kept, _), count in zip(tables, counts, strict=True):
            count[tuple(chosen[axis] if axis in kept else 0 for axis in axes)] += 1.0
        yield tuple(int(each) for each in chosen)


def _marginal(target: Array, kept: tuple[int, ...]) -> Array:
    """Sum over all axes except `kept`; summed axes have length 1."""
    return target.sum(axis=tuple(axis for axis in range(target.ndim) if axis not in kept), keepdims=True)
