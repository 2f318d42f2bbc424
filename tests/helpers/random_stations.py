"""Random station files for tests of searches."""

from datetime import UTC, datetime, timedelta

import numpy as np
from firetwin.stations.records import STATUSES, Availability, Resource, Source, Station
from firetwin.stations.station_file import StationFile
from firetwin.stations.types import standard_types

NOON = datetime(2014, 9, 17, 19, tzinfo=UTC)
CENTRE = (38.9, -120.6)


def random_stations(seed: int, stations: int = 6, resources: int = 10, gaps: float = 0.1) -> StationFile:
    """Stations around `CENTRE` with resources, each number of which is unknown with probability `gaps`."""
    rng = np.random.default_rng(seed)
    types = standard_types()
    bases = [
        Station(
            7 + 3 * k,
            f"Station {k}",
            CENTRE[0] + float(rng.normal(0, 0.4)),
            CENTRE[1] + float(rng.normal(0, 0.5)),
            "exercise",
            1,
        )
        for k in range(stations)
    ]

    def number(low: float, high: float, step: float) -> float | None:
        steps = int(rng.integers(round(low / step), round(high / step) + 1))
        return None if rng.random() < gaps else steps * step

    resources_ = [
        Resource(
            id=int(k),
            station=bases[rng.integers(stations)].id,
            type=types[rng.integers(len(types))].code,
            name=f"Resource {k}",
            origin="exercise",
            source=1,
            count=int(rng.integers(1, 4)),
            load_kg=number(0, 4000, 200),
            speed_km_h=number(30, 120, 10),
            mobilise_min=number(0, 30, 5),
            radius_km=number(20, 90, 10) if rng.random() < 0.3 else None,
            cost_mobilise=number(0, 500, 100),
            cost_hour=number(50, 400, 50),
            currency="USD",
            mode=("attack", "drop", "line")[rng.integers(3)],
            night=bool(rng.random() < 0.5),
        )
        for k in rng.permutation(np.arange(100, 100 + resources))
    ]
    windows = [
        Availability(
            each.id,
            NOON - timedelta(hours=int(rng.integers(0, 6))),
            NOON + timedelta(hours=int(rng.integers(0, 6))),
            STATUSES[rng.integers(2)],
        )
        for each in resources_
        for _ in range(rng.integers(0, 3))
    ]
    source = Source(1, "tests", "none", "2014-09-13")
    return StationFile(tuple(bases), tuple(resources_), tuple(windows), (source,), types)
