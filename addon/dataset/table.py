"""Table of a data set: ``samples.csv``, one row for each sample."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from .. import output
from .formats import common
from .truth import CATEGORIES, Truth

NAME = "samples.csv"
COLUMNS = {
    "index": ("Integer", "number of the sample"),
    "split": ("Text", "split of the sample"),
    "image": ("Text", "path of the visible picture"),
    "kind": ("Text", "fire, or kind of negative"),
    "place": ("Text", "place"),
    "run": ("Text", "model run"),
    "camera": ("Text", "camera site"),
    "utc": ("Text", "model time, ISO 8601"),
    "seconds_since_ignition": ("Float", "model time since the first fire, s; empty without fire"),
    "fires": ("Integer", "number of labelled groups of flames"),
    "smokes": ("Integer", "number of labelled plumes"),
    "below_size": ("Integer", "number of instances below the smallest size"),
    "distance_m": ("Float", "median distance of the nearest labelled instance, m; empty without one"),
}
"""Croissant data type (https://schema.org) and content of each column."""

_FIRE, _SMOKE = (each.id for each in CATEGORIES[:2])


def write(folder: Path, samples: Sequence[Truth], overwrite: bool = False) -> None:
    """Write the table."""
    text = io.StringIO()
    rows = csv.DictWriter(text, list(COLUMNS), lineterminator="\n")
    rows.writeheader()
    rows.writerows(_row(truth) for truth in samples)
    output.write_text(folder / NAME, text.getvalue(), overwrite)


def kind(truth: Truth) -> str:
    """Return the kind of a sample: "fire", or a kind of negative such as "cloud"."""
    return str(truth.draw.get("kind") or ("negative" if truth.is_negative else "fire"))


def _row(truth: Truth) -> dict[str, object]:
    categories = [each.category for each in truth.annotations]
    distances = [each.distance_m for each in truth.annotations]
    return {
        "index": truth.index,
        "split": truth.split or common.UNSPLIT,
        "image": common.picture(truth),
        "kind": kind(truth),
        **{name: truth.groups.get(name, "") for name in ("place", "run", "camera")},
        "utc": truth.utc,
        "seconds_since_ignition": truth.seconds_since_ignition,
        "fires": categories.count(_FIRE),
        "smokes": categories.count(_SMOKE),
        "below_size": len(truth.below_size),
        "distance_m": min((each for each in distances if each is not None), default=None),
    }
