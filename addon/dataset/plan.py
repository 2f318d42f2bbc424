"""Plan of a data set: its runs, the number of samples, the seed, and the distribution of each drawn value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from ..shot.schema import key
from .distributions import DEFAULTS, Distribution

POSITIVE = "fire"
SPLITS = "train", "val", "test"
ANY = "any"
GROUPS = "place", "run", "camera"
_MOST = 1_000_000


def _share(default: float, help: str) -> Any:
    return key(default, help, at_least=0, at_most=_MOST)


@dataclass(frozen=True)
class RunKeys:
    """Names and weight of one run."""

    place: str = key("", "name of the place; runs of one place are in one split")
    name: str = key("", "unique name of the run (name of its folder or scene file)")
    weight: float = key(1.0, "share of the samples, relative to other runs", above=0, at_most=_MOST)
    split: str = key(ANY, "split of the run's group", choices=(ANY, *SPLITS))
    imagery_license: str = key("", "SPDX identifier of the licence of photographs of the ground")


@dataclass(frozen=True, kw_only=True)
class PlanRun(RunKeys):
    """One run of a plan.

    Attributes
    ----------
    run
        Run folder, or a scene file, whose settings apply.
    ensemble, member
        Ensemble and name of the member that the run is converted from; None and "" for other runs.
    """

    run: Path
    ensemble: Path | None = None
    member: str = ""


@dataclass(frozen=True)
class PlanKeys:
    """Numbers and names of a plan."""

    title: str = key("Firetwin samples", "name of the data set")
    license: str = key("", "SPDX identifier of the licence of the data set")
    count: int = key(100, "number of samples", at_least=1, at_most=_MOST)
    seed: int = key(0, "seed of all draws", at_least=0, at_most=2**63 - 1)
    resolution: tuple[int, int] = key(
        (640, 480), "size of the pictures", unit="pixels", at_least=64, at_most=8192
    )
    moments: int = key(8, "model times per run, whose smoke several samples share", at_least=1, at_most=1000)
    sites: int = key(6, "towers per run", at_least=1, at_most=1000)
    positives: float = key(0.6, "share of samples with fire", at_least=0, at_most=1)
    night: float = key(0.25, "share of samples at night", at_least=0, at_most=1)
    split_by: str = key("auto", "group that is never in two splits", choices=("auto", *GROUPS))


@dataclass(frozen=True)
class CameraShares:
    """Relative shares of the kinds of camera."""

    tower: float = _share(0.4, "fixed on high ground")
    drone: float = _share(0.4, "near the front")
    aircraft: float = _share(0.15, "a few kilometres away")
    nadir: float = _share(0.05, "straight down")


@dataclass(frozen=True)
class NegativeShares:
    """Relative shares of the kinds of sample without fire."""

    before_ignition: float = _share(1.0, "the same scenes before the fire")
    cloud: float = _share(1.0, "a cloudy sky")
    fog: float = _share(1.0, "fog")
    dust: float = _share(1.0, "dust")
    low_sun: float = _share(1.0, "a camera towards the low sun")
    night_lights: float = _share(1.0, "lamps at night")
    burned_out: float = _share(1.0, "burned ground after the fire")


@dataclass(frozen=True)
class SplitShares:
    """Relative shares of the splits."""

    train: float = _share(0.7, "for training")
    val: float = _share(0.1, "for the choice of a model")
    test: float = _share(0.2, "for its score")


CAMERAS, NEGATIVES = (tuple(each.name for each in fields(kind)) for kind in (CameraShares, NegativeShares))


@dataclass(frozen=True, kw_only=True)
class Plan(PlanKeys):
    """A data set to render.

    Attributes
    ----------
    path
        The plan's file.
    cameras, negatives, splits
        Relative shares by name.
    draws
        Distribution of each drawn value by its name (see `distributions.DEFAULTS`).
    """

    path: Path
    runs: tuple[PlanRun, ...]
    cameras: Mapping[str, float] = field(default_factory=lambda: asdict(CameraShares()))
    negatives: Mapping[str, float] = field(default_factory=lambda: asdict(NegativeShares()))
    splits: Mapping[str, float] = field(default_factory=lambda: asdict(SplitShares()))
    draws: Mapping[str, Distribution] = field(default_factory=lambda: dict(DEFAULTS))

    def run(self, name: str) -> PlanRun:
        """Return the run with this name."""
        return next(run for run in self.runs if run.name == name)
