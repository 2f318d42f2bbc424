"""The map of the briefing page: its projection, layers and fronts."""

import io

import numpy as np
import pyproj
import pytest
import shapely
import whole_run
from firetwin.brief import front_geojson, layers, map_panel
from firetwin.brief.mercator import Box
from firetwin.ellipsoid import metres_per_degree
from firetwin.errors import InputError
from firetwin.geometry import mercator
from firetwin.run import fronts
from firetwin.run import opening as runs
from firetwin.run.front import reach
from PIL import Image

TO_3857 = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:3857", always_xy=True)


def pixels(layer):
    return np.asarray(Image.open(io.BytesIO(layer.png)).convert("RGBA"))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """An ellipse that runs for 6 hours, over cells of 60 m."""
    times = tuple(np.arange(0.0, 21601.0, 1800.0))
    height = lambda x, y: 800.0 + 200.0 * np.sin(x / 900.0)  # noqa: E731
    folder = whole_run.write(
        tmp_path_factory.mktemp("brief") / "run", cell=60.0, cells=120, times=times, speed=0.12, height=height
    )
    return runs.open(folder)


@pytest.mark.parametrize("latitude", [-84.0, -38.7, 0.0, 38.69, 39.17, 71.0, 85.0])
@pytest.mark.parametrize("longitude", [-179.0, -120.8, 0.0, 151.2])
def test_places_are_projected_as_epsg_3857_has_it(latitude, longitude):
    here = [float(value) for value in mercator.forward(latitude, longitude)]
    assert here == pytest.approx(TO_3857.transform(longitude, latitude), abs=1e-4)  # m
    back = [float(value) for value in mercator.inverse(*here)]
    assert back == pytest.approx((latitude, longitude), abs=1e-11)


def test_corners_of_every_layer_lie_where_epsg_3857_has_the_cells_corners(run):
    half = (
        0.5 * (run.fuel_latitude[1] - run.fuel_latitude[0]),
        0.5 * (run.fuel_longitude[1] - run.fuel_longitude[0]),
    )
    low = TO_3857.transform(run.fuel_longitude[0] - half[1], run.fuel_latitude[0] - half[0])
    high = TO_3857.transform(run.fuel_longitude[-1] + half[1], run.fuel_latitude[-1] + half[0])
    for layer in layers.draw(run, run.fuel_elevation, "UTC"):
        box = layer.box
        assert mercator.forward(box.south, box.west) == pytest.approx(low, abs=1e-3)  # m
        assert mercator.forward(box.north, box.east) == pytest.approx(high, abs=1e-3)


def test_pixel_rows_are_even_in_web_mercator():
    box = Box(38.0, -121.0, 44.0, -115.0)
    _, y = TO_3857.transform(np.full(50, -120.0), box.rows(50))
    assert np.diff(y) == pytest.approx(np.full(49, -box.metres[1] / 50), rel=1e-9)
    assert np.ptp(np.diff(box.rows(50))) > 0.005  # and so not even in latitude
    assert box.share(44.0, -121.0) == pytest.approx((0.0, 0.0))
    assert box.share(38.0, -115.0) == pytest.approx((1.0, 1.0))


@pytest.mark.parametrize("south_first", [True, False])
@pytest.mark.parametrize("west_first", [True, False])
def test_each_pixel_shows_the_cell_that_holds_it(tmp_path, south_first, west_first):
    folder = whole_run.write(tmp_path / "run", cell=4000.0, cells=40, at=(62.0, 15.0), arrival=True)
    rng = np.random.default_rng(5)
    fuel = np.where(rng.random((40, 40)) < 0.5, 0.0, rng.uniform(0.1, 3.0, (40, 40))).astype(np.float32)
    latitude, longitude = (np.load(folder / f"fuel_{name}.npy") for name in ("latitude", "longitude"))
    np.save(folder / "fuel_latitude.npy", latitude if south_first else latitude[::-1])
    np.save(folder / "fuel_longitude.npy", longitude if west_first else longitude[::-1])
    np.save(folder / "surface_fuel.npy", fuel[:: 1 if south_first else -1, :: 1 if west_first else -1])
    layer = layers.draw(run := runs.open(folder), run.fuel_elevation, "UTC")[1]
    alpha = pixels(layer)[..., 3]
    (west, south), (east, north) = (
        TO_3857.transform(x, y)
        for x, y in ((layer.box.west, layer.box.south), (layer.box.east, layer.box.north))
    )
    rows, columns = alpha.shape
    y = north - (np.arange(rows) + 0.5) / rows * (north - south)
    x = west + (np.arange(columns) + 0.5) / columns * (east - west)
    lon, lat = TO_3857.transform(*np.meshgrid(x, y), direction="INVERSE")
    row = np.abs(lat[..., None] - latitude).argmin(-1)
    column = np.abs(lon[..., None] - longitude).argmin(-1)
    assert (alpha > 0).tolist() == (fuel[row, column] > 0.0).tolist()


@pytest.mark.parametrize(("order", "name", "high"), [("us", "tons/acre", 10.0), ("metric", "kg/m²", 2.0)])
def test_the_legend_of_fuel_has_the_units_of_the_user(tmp_path, order, name, high):
    """2 kg/m2 are 8.9 tons/acre, which round up to 10."""
    folder = whole_run.write(tmp_path / "run", cell=60.0, cells=10)
    np.save(folder / "surface_fuel.npy", np.full((10, 10), 2.0, np.float32))
    np.save(folder / "canopy_fuel.npy", np.zeros((10, 10), np.float32))
    run = runs.open(folder)
    legend = layers.draw(run, run.fuel_elevation, "UTC", order)[1].legend
    assert legend.title == f"Fuel load, {name}"
    assert [text for _, text in legend.ticks] == ["0", f"{high / 4:g}", f"{high / 2:g}", f"≥ {high:g}"]


def test_hills_are_lit_from_the_north_west(tmp_path):
    cone = lambda x, y: 3000.0 - 0.6 * np.hypot(x, y)  # noqa: E731
    run = runs.open(whole_run.write(tmp_path / "run", cell=60.0, cells=60, height=cone))
    shade = pixels(layers.draw(run, run.fuel_elevation, "UTC")[0])[..., 0].astype(float)
    rows, columns = shade.shape
    quarter = lambda row, column: shade[int(row * rows), int(column * columns)]  # noqa: E731
    assert quarter(0.25, 0.25) > quarter(0.25, 0.75) + 10 > quarter(0.75, 0.75) + 20


def test_ground_that_does_not_burn_is_transparent_in_the_arrival_layer(run):
    layer = layers.draw(run, run.fuel_elevation, "UTC")[2]
    seen = (pixels(layer)[..., 3] > 0).mean()
    burned = np.isfinite(run.fuel_arrival_time()).mean()
    assert 0.02 < burned < 0.9
    assert seen == pytest.approx(burned, abs=0.02)
    assert [text for _, text in layer.legend.ticks] == ["1 Jul 20:00", "1 Jul 23:00", "2 Jul 02:00"]


def test_a_run_beyond_the_end_of_web_mercator_is_refused(tmp_path):
    run = runs.open(whole_run.write(tmp_path / "run", cell=500.0, cells=40, at=(85.0, 20.0)))
    with pytest.raises(InputError, match=r"extends beyond 85.05 degrees"):
        layers.draw(run, run.fuel_elevation, "UTC")


def test_fronts_lie_within_half_a_cell_of_the_scores_front(run):
    found, tolerance = fronts.find(run, "UTC")
    assert [front.time for front in found] == sorted(front.time for front in found)
    assert (found[0].time, found[-1].time) == (0.0, 21600.0)
    north, east = metres_per_degree(38.9)
    assert tolerance == pytest.approx(30.0, rel=1e-3)  # half a cell
    burning = [front for front in found if front.lines]
    assert len(burning) > 10
    for front in burning:
        latitude, longitude, after = reach(run).line(front.time)
        metres = np.column_stack([longitude * east, latitude * north])
        segments = shapely.MultiLineString([(metres[i], metres[j]) for i, j in enumerate(after)])
        mine = shapely.MultiLineString([line * (east, north) for line in front.lines])
        assert shapely.hausdorff_distance(mine, segments) < tolerance
        assert sum(map(len, front.lines)) <= len(after)
        assert all((line[0] == line[-1]).all() for line in front.lines)
    assert sum(map(len, front.lines)) < 0.7 * len(after)


def test_a_long_front_is_simplified_more_and_the_tolerance_told(run, monkeypatch):
    fine, tolerance = fronts.find(run, "UTC")
    count = sum(len(line) for front in fine for line in front.lines)
    monkeypatch.setattr(fronts, "_MOST_POINTS", int(0.7 * count))
    coarse, told = fronts.find(run, "UTC")
    assert told >= 2.0 * tolerance
    assert sum(len(line) for front in coarse for line in front.lines) <= 0.7 * count
    assert [front.area for front in coarse] == [front.area for front in fine]


@pytest.mark.parametrize("cell", [0.5, 5.0, 74.0, 1000.0])
def test_coordinates_have_the_digits_that_the_cells_need(tmp_path, cell):
    run = runs.open(whole_run.write(tmp_path / "run", cell=cell, cells=30, speed=cell / 400.0))
    found, tolerance = fronts.find(run, "UTC")
    collection = front_geojson.feature_collection(found, tolerance)
    for front, feature in zip(found, collection["features"], strict=True):
        for line, coordinates in zip(front.lines, feature["geometry"]["coordinates"], strict=True):
            moved = np.abs((np.array(coordinates) - line) * 111_320.0).max()
            assert 0.01 * tolerance < moved < 0.18 * tolerance


def test_front_times_are_those_of_the_zones_clock(tmp_path):
    times = tuple(np.arange(0.0, 86400.0 * 2 + 1.0, 3600.0))
    run = runs.open(whole_run.write(tmp_path / "run", cells=20, start="2020-07-01T20:17:00Z", times=times))
    moments = fronts.choose_times(run, "Asia/Kolkata")  # 5 h 30 min east
    assert moments[0] == 0.0
    assert moments[-1] == times[-1]
    inner = np.array(moments[1:-1])
    assert len(inner) <= fronts.MOST
    assert ((inner + (20 * 60 + 17 + 5 * 60 + 30) * 60) % 3600.0).tolist() == [0.0] * len(inner)


def test_simplified_lines_keep_their_corners_and_drop_what_lies_between():
    square = np.array([[0, 0], [1, 0], [2, 0.004], [4, 0], [4, 4], [0, 4], [0, 2], [0, 0]], float)
    kept = fronts.simplify(square, np.array([100.0, 100.0]))
    assert kept.tolist() == [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]


def test_geojson_has_lines_of_longitude_and_latitude(run):
    collection = front_geojson.feature_collection(*fronts.find(run, "UTC"))
    feature = collection["features"][-1]
    assert collection["type"] == "FeatureCollection"
    assert feature["geometry"]["type"] == "MultiLineString"
    assert feature["properties"]["time"] == "2020-07-02T02:00:00Z"
    x, y = np.concatenate(feature["geometry"]["coordinates"]).T
    assert np.abs(x + 120.6).max() < 0.1
    assert np.abs(y - 38.9).max() < 0.1


def test_the_map_opens_on_the_fire(run):
    whole = map_panel.bounds(layers.draw(run, run.fuel_elevation, "UTC"))
    found, _ = fronts.find(run, "UTC")
    box = map_panel.view(found, whole)
    corners = np.concatenate([line for front in found for line in front.lines])
    assert box.west < corners[:, 0].min() < corners[:, 0].max() < box.east
    assert whole.south <= box.south < box.north <= whole.north
    assert map_panel.view(found[:0], whole) == whole


def test_a_run_without_fire_still_has_a_map(tmp_path):
    run = runs.open(whole_run.write(tmp_path / "run", cells=12, fires=((0.0, 0.0, 1e9),)))
    found, _ = fronts.find(run, "UTC")
    assert not any(front.lines for front in found)
    assert len(layers.draw(run, run.fuel_elevation, "UTC")) == 3
