"""Search: results compared with the conditions one by one, and sets compared with all subsets."""

import itertools
import math
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest
from firetwin.stations import cover, measures, search
from firetwin.stations.distance import covers, distance_km
from firetwin.stations.query import Query
from firetwin.stations.records import Area, Availability, Resource, Source, Station
from firetwin.stations.station_file import StationFile
from firetwin.stations.types import standard_types
from random_stations import CENTRE, NOON, random_stations


def one_by_one(station_file, query):
    """Check each resource in plain Python: results with minutes, cost and tonnes."""
    rows = []
    for each in station_file.resources:
        kind, number = each.type.split("/")
        station = next(s for s in station_file.stations if s.id == each.station)
        (far,) = distance_km([station.latitude], [station.longitude], query.near)
        road = 1.0 if kind in ("airtanker", "helicopter") else query.detour
        speed = each.speed_km_h
        minutes = None
        if speed and each.mobilise_min is not None:
            minutes = each.mobilise_min + far * road / speed * 60
        cost = None
        if each.cost_hour is not None:
            cost = each.count * ((each.cost_mobilise or 0.0) + query.hours * each.cost_hour)
        tank = next(t.tank_l for t in station_file.types if t.code == each.type)
        load, tonnes = each.load_kg if each.load_kg is not None else tank, 0.0
        if load is not None:
            way = (far if kind == "airtanker" else query.refill_km) * road
            tonnes = (
                each.count * load / 1e3 / (2 * way / speed + query.turnaround_min / 60) if speed else None
            )
        windows = [
            w for w in station_file.availability if w.resource == each.id and w.begins <= query.at < w.ends
        ]
        status = sorted(windows, key=lambda w: w.begins)[-1].status if windows else None
        passes = (
            (not query.kinds or kind in query.kinds)
            and (not query.types or number in query.types)
            and (not query.modes or each.mode in query.modes)
            and (not query.night or each.night)
            and status == "available"
            and (query.within_km is None or far <= query.within_km)
            and (each.radius_km is None or far <= each.radius_km)
            and (query.minutes is None or (minutes is not None and minutes <= query.minutes))
        )
        if query.tonnes_per_hour is not None and cost is None:
            passes = False
        if query.tonnes_per_hour is not None and not tonnes:
            passes = False
        if passes:
            rows.append((each.id, minutes, cost, tonnes))
    return sorted(rows, key=lambda row: (math.inf if row[1] is None else row[1], row[0]))


def random_query(rng):
    def maybe(value):
        return value if rng.random() < 0.4 else None

    return Query(
        near=(CENTRE[0] + float(rng.normal(0, 0.1)), CENTRE[1] + float(rng.normal(0, 0.1))),
        within_km=maybe(float(rng.uniform(20, 80))),
        minutes=maybe(float(rng.uniform(20, 120))),
        kinds=maybe(("engine", "airtanker", "helicopter")) or (),
        types=maybe(("1", "2", "3")) or (),
        modes=maybe(("attack", "drop")) or (),
        night=bool(rng.random() < 0.2),
        at=NOON,
        hours=float(rng.integers(1, 24)),
    )


def test_a_thousand_searches_find_what_each_condition_finds_one_by_one():
    rng, number = np.random.default_rng(5), 0
    for seed in range(1000):
        station_file, query = random_stations(seed), random_query(rng)
        wanted = one_by_one(station_file, query)
        result = search.survey(station_file, query)
        assert [each.resource.id for each in result.matches] == [row[0] for row in wanted]
        for match, (_, *values) in zip(result.matches, wanted, strict=True):
            got = (match.minutes, match.cost, match.tonnes_per_hour)
            for have, want in zip(got, values, strict=True):
                assert have == want if want is None else have == pytest.approx(want)
        assert len(wanted) + sum(result.left_out.values()) == len(station_file.resources)
        number += len(wanted)
    assert number > 800


def cheapest_of_all(cost, gain, need):
    """Cost and size of the best set, of all subsets."""
    best = None
    for size in range(len(cost) + 1):
        for chosen in itertools.combinations(range(len(cost)), size):
            if sum(gain[k] for k in chosen) >= need:
                key = (sum(cost[k] for k in chosen), size)
                best = key if best is None or key < best else best
    return best


def test_a_thousand_cheapest_sets_are_those_of_all_subsets():
    rng = np.random.default_rng(11)
    for _ in range(1000):
        size = int(rng.integers(1, 11))
        high = int(rng.choice([3, 50, 10_000]))
        cost, gain = (rng.integers(0, high, size) for _ in range(2))
        need = int(rng.integers(1, max(int(gain.sum() * 1.2), 2)))
        best, cheapest = cheapest_of_all(cost.tolist(), gain.tolist(), need), cover.cheapest(cost, gain, need)
        if best is None:
            assert cheapest is None
            continue
        assert gain[cheapest].sum() >= need
        assert (cost[cheapest].sum(), len(cheapest)) == best
        assert (np.diff(cheapest) > 0).all()


def test_of_alike_resources_the_first_are_taken():
    same = np.full(9, 700), np.full(9, 400)
    assert cover.cheapest(*same, 1100).tolist() == [0, 1, 2]


def test_sums_beyond_64_bits_only_lose_the_rule_of_fewest():
    cost = np.full(2000, 10**10)
    cost[5] = 1
    assert cover.cheapest(cost * 100, np.full(2000, 3), 6).tolist() == [0, 5]


def set_query(**more):
    return Query(near=CENTRE, at=NOON, **more)


def test_a_set_is_the_cheapest_of_all_subsets_of_what_passes():
    tried = 0
    for seed in range(150):
        station_file = random_stations(seed, resources=14, gaps=0.0)
        query = set_query(tonnes_per_hour=12.0)
        every = one_by_one(station_file, query)
        result = search.survey(station_file, query)
        gain = [math.floor(row[3] * 1000 + 1e-6) for row in every]
        best = cheapest_of_all([round(row[2] * 100) for row in every], gain, 12_000)
        assert bool(result.shortfall) == (best is None)
        if best is not None:
            assert (round(result.cost * 100), len(result.matches)) == best
            assert result.tonnes_per_hour >= 12.0 - 1e-6
            tried += len(result.matches) > 1
            low = search.survey(station_file, replace(query, budget=result.cost - 1.0))
            assert not low.matches
            assert "more than" in low.shortfall
            assert search.survey(station_file, replace(query, budget=result.cost)).matches == result.matches
    assert tried > 20


def test_the_order_of_rows_changes_nothing():
    station_file = random_stations(3, resources=40, gaps=0.0)
    turned = replace(
        station_file, resources=station_file.resources[::-1], stations=station_file.stations[::-1]
    )
    for query in (set_query(), set_query(tonnes_per_hour=9.0), set_query(budget=9000.0)):
        assert search.find(station_file, query) == search.find(turned, query)


def test_a_budget_alone_pays_what_arrives_first():
    station_file = random_stations(4, resources=40, gaps=0.0)
    every, some = (search.find(station_file, set_query(budget=budget)) for budget in (None, 9000.0))
    left, wanted = 9000.0, []
    for match in every:
        if match.cost <= left:
            wanted.append(match)
            left -= match.cost
    assert some == wanted
    assert 0 < len(some) < len(every)
    exact = sum(match.cost for match in every[:3])
    assert search.find(station_file, set_query(budget=exact)) == every[:3], "to the cent"


def test_distances_are_those_of_geodesics():
    geod = pytest.importorskip("pyproj").Geod(ellps="WGS84")
    rng = np.random.default_rng(2)
    latitude, longitude = rng.uniform(-89, 89, 500), rng.uniform(-180, 180, 500)
    there = latitude + rng.normal(0, 1, 500), longitude + rng.normal(0, 1, 500)
    for k in range(500):
        (found,) = distance_km([there[0][k]], [there[1][k]], (latitude[k], longitude[k]))
        _, _, metres = geod.inv(longitude[k], latitude[k], there[1][k], there[0][k])
        assert found * 1000.0 == pytest.approx(metres, rel=1e-5, abs=0.01)
    assert distance_km([38.0], [-120.0], (38.0, -120.0)).tolist() == [0.0]
    assert distance_km([0.0], [-179.9], (0.0, 179.9))[0] == pytest.approx(22.264, abs=0.001)


SQUARE = np.array([[-121.0, 38.5], [-120.0, 38.5], [-120.0, 39.5], [-121.0, 39.5]])
HOLE = np.array([[-120.7, 38.8], [-120.5, 38.8], [-120.5, 39.0], [-120.7, 39.0]])


def test_a_drawn_area_counts_instead_of_the_radius():
    station = Station(1, "Base", 38.9, -120.1, "user", 1)
    engine = Resource(1, 1, "engine/3", "Engine", "user", 1, radius_km=1.0)
    station_file = StationFile((station,), (engine,), (), (Source(1, "x", "y", "z"),), standard_types())
    assert search.survey(station_file, Query(near=CENTRE)).left_out == {"outside of their response area": 1}
    whole = replace(station_file, areas=(Area(1, "a", "", 1, ((SQUARE,),)),))
    assert [each.coverage for each in search.find(whole, Query(near=CENTRE))] == ["area"]
    holed = replace(station_file, areas=(Area(1, "a", "", 1, ((SQUARE, HOLE),)),))
    assert search.find(holed, Query(near=CENTRE)) == []
    assert covers(holed.areas[0], 38.9, -120.9)
    assert not covers(holed.areas[0], 38.9, -119.9)


def test_the_window_that_begins_last_says_the_status():
    station_file = replace(random_stations(1, resources=1), availability=())
    (each,) = station_file.resources
    day = timedelta(days=1)
    whole = Availability(each.id, NOON - day, NOON + day)
    hour = Availability(each.id, NOON - day / 24, NOON, "committed")
    windows = replace(station_file, availability=(hour, whole))
    at = [measures.statuses(windows, NOON + step * day / 48)[0] for step in (-3, -1, 0, 47, 48)]
    assert at == [1, 0, 1, 1, -1]
    assert search.survey(station_file, Query(at=NOON)).left_out == {"of unknown status then": 1}


def test_costs_without_a_rate_by_the_hour_are_by_days():
    station_file = random_stations(1, resources=1)
    each = replace(station_file.resources[0], cost_hour=None, cost_day=1000.0, cost_mobilise=50.0, count=2)
    daily = replace(station_file, resources=(each,))
    assert [measures.resource_costs(daily, hours)[0] for hours in (1, 24, 25)] == [2100.0, 2100.0, 4100.0]
    free = replace(station_file, resources=(replace(each, cost_day=None),))
    assert np.isnan(measures.resource_costs(free, 1.0)[0])
