"""Ensembles of a few cells, and conversions of members."""

from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np
from firetwin.forecasts import convert as members_convert
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.run.models.model import Options

ISSUED = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)


def make(
    folder: Path, arrival, weights=None, ends=None, horizon=24.0, at=None, issued=ISSUED
) -> ensemble.Ensemble:
    """Write arrival times (m, ny, nx) as an ensemble, and open it; `at`: latitudes and longitudes."""
    arrival = np.asarray(arrival, np.float32)
    count, rows, columns = arrival.shape
    latitude, longitude = at or (38.8 + 1e-3 * np.arange(rows), -120.6 + 1e-3 * np.arange(columns))
    members = [
        Member(f"{i:02}", 1.0 if weights is None else weights[i], np.inf if ends is None else ends[i])
        for i in range(count)
    ]
    head = Manifest("test", "made up", issued, horizon, ())
    out = folder / "ensemble"
    write.write(out, head, latitude, longitude, zip(members, arrival, strict=True))
    return ensemble.open(out)


class Converted(NamedTuple):
    """An ensemble, its arrival times (m, ny, nx) with rows from the north, and the printed messages."""

    ensemble: ensemble.Ensemble
    arrival: np.ndarray
    messages: list[str]


def convert(
    folder: Path | list[Path],
    out: Path,
    start="2014-09-17T04:45Z",
    at="",
    projection="EPSG:32610",
    horizon=0.0,
) -> Converted:
    """Convert a model's members, and open their ensemble."""
    messages: list[str] = []
    paths = folder if isinstance(folder, list) else [folder]
    options = Options.of(start, at, projection, 0.0, [])
    members_convert.in_process(paths, out, options, horizon, tell=messages.append)
    members = ensemble.open(out)
    rows = slice(None, None, -1) if members.latitude[0] < members.latitude[-1] else slice(None)
    arrival = np.stack([members.arrival(index)[rows] for index in range(len(members.members))])
    return Converted(members, arrival, messages)
