"""Plan of a data set: its runs, the number of samples, the seed, and the distribution of each drawn value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from .distributions import DEFAULTS, Distribution

CAMERAS = "tower", "drone", "aircraft", "nadir"
NEGATIVES = "before_ignition", "cloud", "fog", "dust", "low_sun", "night_lights", "burned_out"
POSITIVE = "fire"
SPLITS = "train", "val", "test"
ANY = "any"


@dataclass(frozen=True)
class PlanRun:
    """One run of a plan.

    Attributes
    ----------
    place
        Name of the place. Runs of one place share its terrain, and are never in two splits by place.
    run
        Run folder, or a scene file, whose settings apply.
    name
        Unique name of the run (stem of its folder or scene file).
    weight
        Share of the samples, relative to the other runs.
    split
        Split of the run, or "any": the plan chooses.
    imagery_license
        SPDX identifier of the licence of photographs of the ground in the scene file; "" without any.
    ensemble, member
        Ensemble and name of the member that the run is converted from; None and "" for other runs.
    """

    place: str
    run: Path
    name: str
    weight: float = 1.0
    split: str = ANY
    imagery_license: str = ""
    ensemble: Path | None = None
    member: str = ""


@dataclass(frozen=True)
class Plan:
    """A data set to render.

    Attributes
    ----------
    path
        The plan's file.
    title, license
        Name of the data set, and SPDX identifier of its licence; "" if its owner has not chosen one.
    runs
        Runs that the samples show.
    count
        Number of samples, which are numbered from 1.
    seed
        Seed of all draws.
    resolution
        Width and height of the pictures, pixels.
    moments
        Number of model times per run. Samples of one run and moment share the smoke.
    sites
        Number of tower sites per run.
    positives
        Share of samples with fire, 0..1.
    night
        Share of samples at night, 0..1.
    cameras, negatives
        Relative shares of the kinds of camera, and of samples without fire.
    splits
        Relative shares of the splits.
    split_by
        Group that is never in two splits: "place", "run", "camera", or "auto": the first one that has enough.
    draws
        Distribution of each drawn value by its name (see `distributions.DEFAULTS`).
    """

    path: Path
    runs: tuple[PlanRun, ...]
    count: int = 100
    seed: int = 0
    title: str = "Firetwin samples"
    license: str = ""
    resolution: tuple[int, int] = (640, 480)
    moments: int = 8
    sites: int = 6
    positives: float = 0.6
    night: float = 0.25
    cameras: Mapping[str, float] = field(
        default_factory=lambda: dict(zip(CAMERAS, (0.4, 0.4, 0.15, 0.05), strict=True))
    )
    negatives: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(NEGATIVES, 1.0))
    splits: Mapping[str, float] = field(default_factory=lambda: {"train": 0.7, "val": 0.1, "test": 0.2})
    split_by: str = "auto"
    draws: Mapping[str, Distribution] = field(default_factory=lambda: dict(DEFAULTS))

    def run(self, name: str) -> PlanRun:
        """Return the run with this name."""
        return next(run for run in self.runs if run.name == name)
