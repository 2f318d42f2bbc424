"""Ensembles of a few cells."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member

ISSUED = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)


def make(folder: Path, arrival, weights=None, ends=None, horizon=24.0) -> ensemble.Ensemble:
    """Write arrival times (m, ny, nx) as an ensemble, and open it."""
    arrival = np.asarray(arrival, np.float32)
    count, rows, columns = arrival.shape
    latitude, longitude = 38.8 + 1e-3 * np.arange(rows), -120.6 + 1e-3 * np.arange(columns)
    members = [
        Member(f"{i:02}", 1.0 if weights is None else weights[i], np.inf if ends is None else ends[i])
        for i in range(count)
    ]
    head = Manifest("test", "made up", ISSUED, horizon, ())
    out = folder / "ensemble"
    write.write(out, head, latitude, longitude, zip(members, arrival, strict=True))
    return ensemble.open(out)
