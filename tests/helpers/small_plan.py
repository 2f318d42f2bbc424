"""Plans of data sets of made-up runs."""

from pathlib import Path

import numpy as np
import whole_run
from firetwin.dataset.plan import Plan, PlanRun


def hills(east, north):
    """Ridges of 120 m, 900 m apart."""
    return 500.0 + 60.0 * np.sin(east * 2.0 * np.pi / 900.0) * np.cos(north * 2.0 * np.pi / 1300.0)


def write_run(folder, **more):
    """Write a run of 7.7 km with ridges, wind and trees."""
    return whole_run.write(folder, **({"cell": 120.0, "height": hills, "canopy": 0.5} | more))


def plan(*names, folder=Path("runs"), **more):
    """Plan of runs in folders of these names, one place each."""
    runs = tuple(PlanRun(f"Place {name}", name, run=folder / name) for name in names or ("a",))
    return Plan(**({"path": folder / "plan.toml", "runs": runs, "seed": 7} | more))
