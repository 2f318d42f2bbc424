"""Scores: closed forms, properties, and oracles that we did not write."""

import base64
import importlib.util
import io
import json
import re
import subprocess
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
import whole_run
from fires import LATITUDE, LONGITUDE, axes, circle, degrees, geojson, round_fire, square, write_run
from firetwin import extras
from firetwin.errors import UsageError
from firetwin.html_text import quote
from firetwin.run import observations, readers
from firetwin.run import opening as runs
from firetwin.run import score as scores
from firetwin.run.observations import Perimeter
from firetwin.run.score import arrival, page, plots, report, shapes
from firetwin.run.score.grid import ScoreGrid
from firetwin.run.score.overlap import Overlap
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from matplotlib import image
from matplotlib.colors import to_rgb
from module_file import load_module
from page_parts import PageParts

shapely = pytest.importorskip("shapely")
SPEED = 0.5  # m/s
START = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)


@pytest.fixture
def round_run(make_run):
    """A run of 6 km and 2 hours whose fire grows as a circle; burned before: 300 m."""
    time = round_fire(*axes(), SPEED) - 300.0 / SPEED
    time[time > 3600.0] = np.nan
    return lambda **fields: readers.open(write_run(make_run, time, **fields))


def seen(time, *rings):
    return Perimeter(time, (tuple(rings),), "seen.geojson")


def lens(r, s, d):
    """Area that two circles share."""
    a = np.arccos((d * d + r * r - s * s) / (2 * d * r))
    b = np.arccos((d * d + s * s - r * r) / (2 * d * s))
    root = (-d + r + s) * (d + r - s) * (d - r + s) * (d + r + s)
    return r * r * a + s * s * b - 0.5 * np.sqrt(root)


def test_two_circles_by_their_closed_forms(round_run):
    """After 1,400 s the run's circle has 1,000 m; one of 800 m was seen, 500 m to the east."""
    when = START + timedelta(seconds=1400)
    run = round_run()
    found = scores.score(run, observations.Observations((seen(when, circle(800.0, 500.0)),)))
    (row,) = found["dates"]
    both, here, there = lens(1000.0, 800.0, 500.0), np.pi * 1e6, np.pi * 800.0**2
    expected = {
        "area": here,
        "observed_area": there,
        "sorensen": 2 * both / (here + there),
        "jaccard": both / (here + there - both),
        "precision": both / here,
        "recall": both / there,
        "sdi": (here + there - 2 * both) / there,
        "adi": (here + there - 2 * both) / both,
    }
    for name, value in expected.items():
        assert row["all"]["polygons"][name] == pytest.approx(value, rel=2e-3), name
        assert row["all"]["cells"][name] == pytest.approx(value, rel=2e-2), name
        assert row["all"]["error"][name] < 0.02 * value
    assert row["distance"]["hausdorff"] == pytest.approx(700.0, abs=5.0)  # west ends: -1,000 and -300
    without = row["without_start"]["polygons"]
    assert without["area"] == pytest.approx(here - np.pi * 300.0**2, rel=2e-3)
    assert without["observed_area"] == pytest.approx(there - np.pi * 300.0**2, rel=2e-3)
    assert without["hits"] == pytest.approx(both - np.pi * 300.0**2, rel=3e-3)


def test_squares_with_known_distances():
    projection = shapes.Projection(LATITUDE, LONGITUDE)
    one, two = (
        projection.project(shapes.of_perimeter(seen(START, ring), LONGITUDE))
        for ring in (square(1000.0), square(1000.0, 300.0, 0.0))
    )
    found = shapes.distances(one, two, 5.0)
    assert found["hausdorff"] == pytest.approx(300.0, rel=2e-3)
    assert found["run_to_observed"] == pytest.approx(found["observed_to_run"], rel=1e-2)
    assert found["mean"] == pytest.approx(_mean_distance(1000.0, 300.0), rel=5e-3)


def _mean_distance(side, shift):
    """Mean distance of the rim of a square from the rim of a square `shift` beyond, in small steps."""
    at = np.linspace(0, side, 4001)
    west = np.full_like(at, shift)  # straight to the other's west side
    east = np.minimum(shift, np.minimum(at, side - at))  # inside of the other
    along = np.where(at < shift, shift - at, 0.0)  # south and north lie on the other's beyond its corner
    return float(np.mean([west.mean(), east.mean(), along.mean(), along.mean()]))


def test_hausdorff_and_areas_by_shapely_itself():
    rng = np.random.default_rng(5)
    for _ in range(5):
        one, two = (shapely.MultiPoint(rng.uniform(0, 1000, (12, 2))).convex_hull for _ in range(2))
        ours = shapes.distances(one, two, 1.0)["hausdorff"]
        theirs = shapely.hausdorff_distance(one.boundary, two.boundary, densify=0.01)
        assert ours == pytest.approx(theirs, abs=2.0)
        found = Overlap.of_polygons(one, two, shapely.box(0, 0, 1000, 1000)).scores()
        assert found["jaccard"] == pytest.approx(one.intersection(two).area / one.union(two).area)


@settings(deadline=None, max_examples=examples(12))
@given(st.integers(0, 2**32 - 1), st.integers(1, 40))
def test_cells_by_scikit_learn(seed, side):
    metrics = pytest.importorskip("sklearn.metrics")
    rng = np.random.default_rng(seed)
    run, there = rng.random((2, side, side)) < rng.uniform(0.05, 0.95, (2, 1, 1))
    weight = rng.uniform(1, 2, (side, side))
    scores_ = Overlap.of_cells(run, there, weight).scores()
    options = {"sample_weight": weight.ravel(), "zero_division": 0.0}
    oracle = {
        "sorensen": metrics.f1_score,
        "jaccard": metrics.jaccard_score,
        "precision": metrics.precision_score,
        "recall": metrics.recall_score,
    }
    for name, function in oracle.items():
        assert (scores_[name] or 0.0) == pytest.approx(function(there.ravel(), run.ravel(), **options))
    if 0 < there.sum() < there.size or 0 < run.sum() < run.size:
        kappa = metrics.cohen_kappa_score(there.ravel(), run.ravel(), sample_weight=weight.ravel())
        assert scores_["kappa"] == pytest.approx(kappa, abs=1e-12)


areas_of = st.floats(0.0, 1e9, allow_subnormal=False)


@given(areas_of, areas_of, areas_of, areas_of)
def test_scores_are_bounded_and_symmetric(both, here, there, neither):
    own_scores = Overlap(both, here, there, neither).scores()
    other = Overlap(both, there, here, neither).scores()
    for name in ("sorensen", "jaccard", "precision", "recall"):
        assert own_scores[name] is None or 0.0 <= own_scores[name] <= 1.0
    for name in ("sorensen", "jaccard", "kappa", "adi"):
        assert (
            own_scores[name] == pytest.approx(other[name])
            if own_scores[name] is not None
            else other[name] is None
        )
    assert own_scores["precision"] == other["recall"]
    if both > 0.0:
        assert own_scores["sorensen"] == pytest.approx(
            2 * own_scores["jaccard"] / (1 + own_scores["jaccard"])
        )


def test_a_run_against_itself_is_perfect(round_run):
    run = round_run()
    report = scores.score(run, observations.Observations(), run)
    assert len(report["dates"]) == scores.SAMPLES
    for row in report["dates"]:
        assert row["all"]["polygons"]["sorensen"] == pytest.approx(1.0, abs=1e-4)
        assert row["all"]["cells"]["jaccard"] > 0.97  # the polygon of the other, on cells again
        assert row["distance"]["hausdorff"] < 1.0
    assert report["arrival"]["bias"] == report["arrival"]["rmse"] == 0.0
    assert report["arrival"]["run_only"] == report["arrival"]["seen_only"] == 0


@pytest.mark.parametrize("cell", [30.0, 77.0])
def test_arrival_error_of_a_slow_circle_is_that_of_the_formula(tmp_path, cell):
    """Speeds of 0.25 and 0.3 m/s; both cover 600 to 3000 s, so rings from 180 to 750 m count.

    Of all cells that the longer run covers, up to 900 m, the error would be 15 % more.
    """
    slow = {"cells": 82, "wind": None, "speed": 0.25, "times": (0.0, 1800.0, 3600.0)}
    fast = {"cells": round(82 * 30.0 / cell), "cell": cell, "wind": None, "speed": 0.3}
    one = runs.open(whole_run.write(tmp_path / "slow", **slow))
    two = runs.open(whole_run.write(tmp_path / "fast", **fast, times=(600.0, 1800.0, 3000.0)))
    low, high = 600.0 * 0.3, 3000.0 * 0.25
    mean = 2.0 / 3.0 * (high**3 - low**3) / (high**2 - low**2)  # m, of the distance in the ring
    found = scores.score(one, observations.Observations(), two)["arrival"]
    assert found["bias"] == pytest.approx((1.0 / 0.25 - 1.0 / 0.3) * mean, rel=0.02)
    area = np.pi * (high**2 - low**2) / 30.0**2
    assert found["cells"] == pytest.approx(area, rel=0.03)


def test_arrival_times_count_cell_by_cell_where_both_burned():
    """NaN on one side only enters no mean and is counted."""
    run = np.array([[-5.0, 100.0, 200.0, np.nan, 300.0, np.nan]])
    there = np.array([[-9.0, 160.0, np.nan, 400.0, 270.0, np.nan]])
    found = arrival.between(run, there, (0.0, 1000.0))
    assert (found["cells"], found["run_only"], found["seen_only"]) == (2, 1, 1)
    assert found["bias"] == pytest.approx((-60.0 + 30.0) / 2)
    assert found["mae"] == pytest.approx(45.0)
    assert found["rmse"] == pytest.approx(np.sqrt((60.0**2 + 30.0**2) / 2))


def test_arrival_between_perimeters_is_wrong_only_outside_of_their_interval(round_run):
    """Perimeters of a fire as fast as the run's: no error; of one ten minutes later: most cells are early."""
    moments = [600.0, 1200.0, 1800.0]

    def perimeters(late):
        return tuple(
            seen(START + timedelta(seconds=m), circle(r))
            for m, r in ((m, 300.0 + SPEED * (m - late)) for m in moments)
        )

    same = scores.score(round_run(), observations.Observations(perimeters(0.0)))["arrival"]
    assert same["mae"] < 5.0
    assert same["cells"] > 1000


def test_what_never_burns_has_a_whole_rim(round_run):
    """Cells that never burn do not take half a cell from the area inside (a fault of masked contours)."""
    run = round_run()
    grid = ScoreGrid.from_run(run)
    burned = float(grid.areas[~np.isnan(grid.arrival)].sum())
    assert grid.polygon(1e9).area == pytest.approx(burned, rel=5e-3)


def test_the_edge_of_the_grid_is_half_a_cell_beyond_the_last_middles():
    latitude, longitude = axes(20, 100.0)
    grid = ScoreGrid(latitude, longitude, np.zeros((20, 20)))
    assert grid.polygon(1.0).area == pytest.approx(grid.domain, rel=0.01)
    assert grid.box.area == pytest.approx(grid.domain, rel=1e-6)


def test_areas_are_those_of_the_ellipsoid():
    """Lambert's projection against geodesic areas by GeographicLib (pyproj's Geod)."""
    from pyproj import Geod

    ring = circle(5000.0)
    projected = shapes.Projection(LATITUDE, LONGITUDE).project(shapely.Polygon(ring)).area
    exact, _ = Geod(ellps="WGS84").polygon_area_perimeter(*ring.T)
    assert projected == pytest.approx(abs(exact), rel=1e-6)


@pytest.mark.parametrize(("flip_rows", "flip_columns"), [(True, False), (False, True), (True, True)])
def test_rows_from_the_north_and_columns_from_the_east_score_the_same(round_run, flip_rows, flip_columns):
    latitude, longitude = axes()
    time = round_fire(latitude, longitude, SPEED, 200.0, 100.0).astype(np.float32)
    rows, columns = slice(None, None, -1 if flip_rows else 1), slice(None, None, -1 if flip_columns else 1)
    plain = ScoreGrid(latitude, longitude, time)
    turned = ScoreGrid.from_run(
        round_run(
            fuel_latitude=latitude[rows],
            fuel_longitude=longitude[columns],
            fuel_arrival_time=time[rows, columns],
        )
    )
    assert turned.polygon(1500.0).symmetric_difference(plain.polygon(1500.0)).area < 1.0


def test_crossing_rings_and_holes_are_taken_apart():
    """A bow tie has two triangles; a hole is not burned."""
    bow = degrees([0, 1000, 0, 1000], [0, 1000, 1000, 0])
    projection = shapes.Projection(LATITUDE, LONGITUDE)
    tie = projection.project(shapes.of_perimeter(seen(START, bow), LONGITUDE))
    assert tie.area == pytest.approx(0.5e6, rel=1e-3)
    ring = projection.project(
        shapes.of_perimeter(seen(START, square(1000.0), square(500.0, 250, 250)), LONGITUDE)
    )
    assert ring.area == pytest.approx(0.75e6, rel=1e-3)


def test_a_perimeter_on_the_other_side_of_the_antimeridian():
    far = shapes.of_perimeter(seen(START, circle(500.0) + np.array([360.0, 0.0])), LONGITUDE)
    assert far.centroid.x == pytest.approx(LONGITUDE)


def test_detections_and_their_lag(round_run, tmp_path):
    """30 min after the start the front is 1,200 m out: at 700 m for 1,000 s, and not yet at 1,300 m."""
    rows = ["latitude,longitude,acq_date,acq_time,scan,track,confidence,instrument"]
    for east in (700.0, 1300.0, 2500.0):
        longitude, latitude = degrees([east], [0.0])[0]
        rows.append(f"{latitude},{longitude},2014-09-17,515,0.375,0.375,n,VIIRS")
    path = tmp_path / "viirs.csv"
    path.write_text("\n".join(rows))
    (found,) = scores.score(round_run(), observations.read([path]))["detections"]
    assert (found["count"], found["inside"], found["within_pixel"], found["never"]) == (3, 1, 2, 1)
    assert found["lag_mean"] == pytest.approx((1000.0 - 200.0) / 2, abs=60.0)


def test_the_command_as_a_table_and_as_json(round_run, tmp_path):
    run = round_run()
    file = geojson(
        tmp_path / "king.geojson",
        ([circle(900.0)], {"time": "2014-09-17T05:05:00Z"}),
        ([circle(900.0)], {"time": "2013-09-17T05:05:00Z"}),
    )
    command = [sys.executable, "-m", "firetwin", "score", run.path, "--against", str(file)]
    result = subprocess.run([*command, "--json"], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    found = json.loads(result.stdout)
    assert found["dates"][0]["all"]["polygons"]["sorensen"] == pytest.approx(1.0, abs=5e-3)
    assert (found["uses"][0]["used"], found["uses"][0]["before"]) == (1, 1)
    text = page.page(found)
    assert "0.99" in text
    assert ["king.geojson,", "perimeters", "1", "1", "0", "0"] in [line.split() for line in text.splitlines()]


def test_without_shapely_the_command_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "shapely", None)
    with pytest.raises(UsageError, match=re.escape(extras.install("score"))):
        shapes.needed()


def test_names_in_the_report_do_not_turn_its_text():
    assert quote("a\u202egpj.<b>") == "a\\u202egpj.&lt;b&gt;"


@pytest.mark.parametrize("against", ["perimeters", "run"])
def test_the_report_is_one_page_with_its_pictures_inside(round_run, against):
    run = round_run()
    when = [START + timedelta(seconds=s) for s in (900, 1800)]
    circles = tuple(
        seen(each, circle(radius, 200.0)) for each, radius in zip(when, (700.0, 1100.0), strict=True)
    )
    seen_too = observations.Observations(circles if against == "perimeters" else ())
    others = [] if against == "perimeters" else [run]
    text = report.html(run, scores.score(run, seen_too, *others), seen_too, *others)
    parts = PageParts(text)
    links = [
        value
        for _, attributes, _ in parts.elements
        for name, value in attributes.items()
        if name in ("src", "href", "xlink:href", "data")
    ]
    assert all(each.startswith(("#", "data:")) for each in links if each)
    assert f'<meta http-equiv="Content-Security-Policy" content="{report.POLICY}">' in text
    assert len(parts.all("svg")) == 1
    pictures = [attributes["src"] for attributes, _ in parts.all("img")]
    assert len(pictures) == (2 if against == "perimeters" else scores.SAMPLES)
    for picture in pictures:
        head, data = picture.split(",")
        assert head == "data:image/png;base64"
        assert base64.b64decode(data).startswith(b"\x89PNG")
    for tag in ("main", "table", "section", "div"):
        assert len(parts.all(tag)) == text.count(f"</{tag}>"), tag
    assert "synthetic" not in text


def test_maps_show_what_was_hit_missed_and_invented(round_run):
    """One pixel of each: the run's circle and one 500 m to the east of it."""
    run = round_run()
    grid = ScoreGrid.from_run(run)
    here, there = grid.polygon(1400.0), grid.projection.project(shapely.Polygon(circle(1000.0, 500.0)))
    data = plots.overlap(run, grid, here, there, here.union(there)).partition(",")[2]
    pixels = image.imread(io.BytesIO(base64.b64decode(data)))[..., :3]
    row = pixels[pixels.shape[0] // 2 - 20]
    order = [_nearest_of(row[int(x * len(row))]) for x in (0.2, 0.5, 0.85)]
    assert order == [plots.FALSE_ALARMS, plots.HITS, plots.MISSES]


def _nearest_of(pixel):
    colours = (plots.HITS, plots.FALSE_ALARMS, plots.MISSES)
    return min(colours, key=lambda each: np.abs(np.array(to_rgb(each)) - pixel).sum())


def test_the_king_fires_own_score_says_what_it_cannot_show(make_run):
    """The small run depicts the King Fire and is synthetic: reported areas, no overlap, and notes on both."""
    found = scores.score(readers.open(make_run()), observations.Observations())
    assert [row["time"] for row in found["reported"]][1] == "2014-09-17T04:45:00Z"
    text = page.page(found)
    assert "not where" in text
    assert "SYNTHETIC" in text
    assert "proves nothing of a model" in text


def _firebench(part):
    """A module of firebench by its file: the whole package loads forty others."""
    found = importlib.util.find_spec("firebench")
    if found is None:
        pytest.skip("firebench is not installed")
    path = Path(found.submodule_search_locations[0]) / part
    return load_module(path)


def test_masks_and_arrival_times_by_firebench():
    rng = np.random.default_rng(7)
    run, there = rng.random((2, 30, 30)) < 0.4
    found = Overlap.of_cells(run, there, np.ones((30, 30))).scores()
    matrix = _firebench("metrics/confusion_matrix/utils.py").binary_cm(there, run)
    binary = _firebench("metrics/confusion_matrix/binary_performance.py")
    assert found["precision"] == pytest.approx(binary.binary_precision(matrix))
    assert found["recall"] == pytest.approx(binary.binary_recall_rate(matrix))
    assert found["sorensen"] == pytest.approx(binary.binary_f_score(matrix))
    one, two = rng.uniform(1.0, 100.0, (2, 30, 30))
    errors = arrival.between(one, two, (0.0, 1000.0))
    stats = _firebench("metrics/stats/dataset_1D.py")
    assert errors["rmse"] == pytest.approx(stats.rmse(one, two))
    assert errors["mae"] == pytest.approx(stats.mae(one, two))
    assert abs(errors["bias"]) == pytest.approx(abs(stats.bias(one, two)))


def test_polygons_by_firebench():
    geopandas = pytest.importorskip("geopandas")
    index = _firebench("metrics/perimeter/shape_index.py")
    rings = circle(900.0), circle(700.0, 400.0)
    projection = shapes.Projection(LATITUDE, LONGITUDE)
    one, two = (projection.project(shapely.Polygon(ring)) for ring in rings)
    found = Overlap.of_polygons(one, two, one.union(two)).scores()
    frames = [geopandas.GeoDataFrame(geometry=[shapely.Polygon(ring)], crs="EPSG:4326") for ring in rings]
    assert found["jaccard"] == pytest.approx(index.jaccard_polygon(*frames), rel=1e-5)
    assert found["sorensen"] == pytest.approx(index.sorensen_dice_polygon(*frames), rel=1e-5)
