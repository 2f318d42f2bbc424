"""Splits: complete places, runs or cameras in train, val and test; never single pictures."""

from __future__ import annotations

from collections.abc import Mapping

from .hashing import share
from .plan import ANY, CAMERAS, GROUPS, SPLITS, Plan, PlanRun


class Splits:
    """Splits of a plan.

    Attributes
    ----------
    by
        Kind of the groups, one of `plan.GROUPS`.
    of_group
        Split of each group: of a place, of a run, or of "run/camera site".
    """

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.by = plan.split_by if plan.split_by != "auto" else _choose(plan)
        weights = _groups(plan, self.by)
        fixed = {_group(run, self.by): run.split for run in plan.runs if run.split != ANY}
        if self.by == "camera":
            runs = {run.name: run.split for run in plan.runs if run.split != ANY}
            fixed = {name: runs[name.split("/")[0]] for name in weights if name.split("/")[0] in runs}
        wanted = {name: plan.splits.get(name, 0.0) for name in SPLITS}
        self.of_group = assign(weights, wanted, fixed, plan.seed)

    def of(self, run: str, site: str) -> str:
        """Return the split of a sample of a run by a camera site."""
        group = f"{run}/{site}" if self.by == "camera" else _group(self._plan.run(run), self.by)
        return self.of_group[group]

    def shares(self) -> dict[str, float]:
        """Compute the expected share of each split."""
        weights, found = _groups(self._plan, self.by), dict.fromkeys(SPLITS, 0.0)
        for group, split in self.of_group.items():
            found[split] += weights[group] / sum(weights.values())
        return found


def assign(
    weights: Mapping[str, float], wanted: Mapping[str, float], fixed: Mapping[str, str], seed: int
) -> dict[str, str]:
    """Assign groups to splits: the heaviest first, each to the split that needs most.

    A split without a group gets one before another one gets its next, if only as many groups remain.

    Parameters
    ----------
    weights
        Weight of each group.
    wanted
        Relative shares of the splits.
    fixed
        Splits that are given.
    """
    total, all_shares = sum(weights.values()), sum(wanted.values())
    left = {split: part / all_shares * total for split, part in wanted.items() if part > 0.0}
    split_of = dict(fixed)
    for group, split in fixed.items():
        left[split] = left.get(split, 0.0) - weights[group]
    open_groups = sorted(
        (group for group in weights if group not in fixed),
        key=lambda group: (-weights[group], share(seed, 0, 0, f"split {group}")),
    )
    for number, group in enumerate(open_groups):
        empty = [split for split in left if wanted.get(split, 0.0) > 0.0 and split not in split_of.values()]
        choices = empty if empty and len(empty) >= len(open_groups) - number else list(left)
        best = max(choices, key=lambda split: left[split])
        split_of[group] = best
        left[best] -= weights[group]
    return split_of


def _choose(plan: Plan) -> str:
    """Choose the first kind of group that has at least one group for each split."""
    needed = sum(1 for part in plan.splits.values() if part > 0.0)
    enough = (by for by in GROUPS[:2] if len(_groups(plan, by)) >= needed)
    return next(enough, GROUPS[2])


def _group(run: PlanRun, by: str) -> str:
    """Return the group of a run. Members of an ensemble share one, as their fires resemble each other."""
    return run.place if by == "place" else str(run.ensemble or run.name)


def _groups(plan: Plan, by: str) -> dict[str, float]:
    """Return the weight of each group."""
    weights: dict[str, float] = {}
    for run in plan.runs:
        if by == "camera":
            weights |= {f"{run.name}/{site}": run.weight * part for site, part in _sites(plan).items()}
        else:
            group = _group(run, by)
            weights[group] = weights.get(group, 0.0) + run.weight
    return weights


def _sites(plan: Plan) -> dict[str, float]:
    """Return the camera sites of a run: towers, and a flight of each other kind at each moment."""
    found: dict[str, float] = {}
    for kind in CAMERAS:
        if part := plan.cameras.get(kind, 0.0):
            count = plan.sites if kind == "tower" else plan.moments
            found |= {f"{kind}-{number + 1}": part / count for number in range(count)}
    return found
