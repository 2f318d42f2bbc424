"""Maps of burn probability: their meaning in each model, and the reason why none can burn in a film.

A probability has four parts: of what, by when, given what, out of how many. File names say which model wrote
a map; values do not.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError, input_error


@dataclass(frozen=True)
class Meaning:
    """Meaning of a map.

    Attributes
    ----------
    name
        Pattern of the file name, without extension, in lower case.
    of
        Meaning of the values.
    needs
        Data for an ensemble in its place.
    """

    name: str
    of: str
    needs: str


MEANINGS = (
    Meaning(
        r"times_burned(_\d+)?",
        "counts of ELMFIRE's cases that burned a cell, without their number and times",
        "the arrival maps of its cases (time_of_arrival_CASE_SECONDS.tif)",
    ),
    Meaning(
        r"burn_count.*|burn_probability(_.*)?_t\d+",
        "GridFire's share of simulations that burned a cell by a time",
        "arrival times of each simulation",
    ),
    Meaning(
        r"fire_probability.*|(mean|min)_arrival_time.*|(fireline_intensity|ros)_(mean|max)_\d+",
        "PROPAGATOR's share of realisations, or a statistic of those that burned",
        "arrival times of each realisation",
    ),
    Meaning(
        r"fspro.*",
        "FSPro's share of simulations of drawn weather within days, without a clock",
        "arrival times of each simulation",
    ),
    Meaning(
        r"(fsim|bp_|flp\d).*",
        "FSim's yearly probability, over drawn ignitions and weather of many years",
        "simulations of this fire",
    ),
    Meaning(
        r"(flammap|iftdss|cflp|cfl_)(?!.*arrival).*",
        "a probability given an ignition somewhere in the area, in one weather (FlamMap, IFTDSS)",
        "simulations of this fire",
    ),
    Meaning(
        r".*_landfire_\d\d_.*|[a-z]+-[a-z-]+_\d\d_\d{3}|time-of-arrival(_\d\d)?",
        "one simulation that stands for a rank of fire size, not a quantile of arrival times",
        "time-of-arrival_10.tif to time-of-arrival_90.tif with --members, for an ensemble of ranks",
    ),
    Meaning(
        r".*burn[_ -]?prob.*",
        "burn probabilities without the meaning of their number",
        "arrival times of each simulation",
    ),
)


def refusal(path: Path) -> InputError | None:
    """Return the reason why a map is not an ensemble; None for other files."""
    stem = path.stem.lower()
    for meaning in MEANINGS:
        if re.fullmatch(meaning.name, stem):
            reason = f"holds {meaning.of}: no fire can burn from it"
            return input_error(path, f"{reason}; give {meaning.needs}")
    return None
