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
        r"burn_count.*|burn_probability_.*t\d+",
        "GridFire's share of simulations that burned a cell by a time",
        "arrival times of each simulation",
    ),
    Meaning(
        r"fire_probability.*|mean_arrival_time.*|min_arrival_time.*",
        "PROPAGATOR's share of realisations, or a statistic of those that burned",
        "arrival times of each realisation",
    ),
    Meaning(
        r"fspro.*",
        "FSPro's share of simulations of drawn weather within days, without a clock",
        "arrival times of each simulation",
    ),
    Meaning(
        r"(fsim|flp\d|cflp|bp|iftdss|flammap).*",
        "a yearly probability, or one given an ignition somewhere, not a forecast of one fire",
        "simulations of this fire",
    ),
    Meaning(
        r".*_landfire_(10|30|50|70|90)_.*|.*_(10|30|50|70|90)_\d{3}|time-of-arrival_\d\d",
        "one simulation that stands for a rank of fire size, not a quantile of arrival times",
        'all simulations, or a list of the ranks with kind = "ranked"',
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
