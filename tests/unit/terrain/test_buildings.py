"""Buildings by one rule: heights, mended and omitted outlines, positions, and blocks."""

import builtins
import json

import numpy as np
import pytest
from firetwin import limits
from firetwin.errors import Error, InputError
from firetwin.geometry.polygons import area, inside
from firetwin.run import buildings
from firetwin.run.buildings import blocks, placement, rings
from firetwin.run.buildings.footprints import ASSUMED, STOREY

SQUARE = np.array([(0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)])
HOLE = np.array([(5.0, 3.0), (5.0, 7.0), (9.0, 7.0), (9.0, 3.0)])
BOW = np.array([(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)])
HORSESHOE = np.array(
    [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (25.0, 20.0), (25.0, 5.0), (5.0, 5.0), (5.0, 20.0), (0.0, 20.0)]
)


@pytest.fixture
def without_shapely(monkeypatch):
    real = builtins.__import__

    def import_(name, *rest):
        if name == "shapely":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", import_)


@pytest.mark.parametrize(
    ("properties", "height"),
    [
        ({"height": "9 m"}, 9.0),
        ({"height": 7}, 7.0),
        ({"Building:Levels": 3, "height": "tall"}, 3 * STOREY),
        ({"height": 12, "building:levels": 9}, 12.0),
        ({"num_floors": "2"}, 2 * STOREY),
        ({"height": -1.0}, None),
        ({"height": 9000}, None),
        ({"building:levels": 0}, None),
        ({"height": None}, None),
        ({}, None),
    ],
)
def test_the_height_is_the_own_one_else_by_storeys_else_not_known(properties, height):
    found = buildings.height_of(properties)
    assert found == (None if height is None else pytest.approx(height))


def test_what_was_assumed_and_mended_is_counted_and_said():
    pytest.importorskip("shapely", reason="needs shapely")
    found = buildings.collect([(((SQUARE,),), 9.0), (((SQUARE,), (SQUARE + 50.0,)), None), (((BOW,),), 6.0)])
    assert (found.assumed, found.mended, found.refused) == (1, 1, 0)
    assert [each.height for each in found.outlines] == [9.0, ASSUMED, ASSUMED, 6.0, 6.0]
    assert [each.number for each in found.outlines] == [0, 1, 1, 2, 2]
    assert found.summary() == (
        "footprints of buildings: 5; 1 without a height are 5 m high; 1 crossed themselves and were split"
    )


def test_a_footprint_of_many_corners_is_left_out_and_all_together_are_limited(monkeypatch):
    angle = np.linspace(0.0, 2.0 * np.pi, 300_000, endpoint=False)
    round_ = 10.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    found = buildings.collect([(((round_,),), 9.0), (((SQUARE,),), 6.0)])
    assert (len(found.outlines), found.too_large) == (1, 1)
    assert "1 have more than 5,000 corners and are left out" in found.summary()
    monkeypatch.setattr(limits, "FOOTPRINT_CORNERS", 7)
    with pytest.raises(Error, match="have more than 7 corners; cut out the area"):
        buildings.collect([(((SQUARE,),), 9.0), (((SQUARE + 50.0,),), 9.0)])


def test_without_shapely_what_crosses_itself_is_left_out_and_said(without_shapely):
    flat = np.array([(0.0, 0.0), (4.0, 0.0), (8.0, 0.0)])
    found = buildings.collect([(((SQUARE[::-1],), (BOW,), (flat,)), 9.0)])
    assert [each.outer.tolist() for each in found.outlines] == [SQUARE.tolist()]
    assert (found.mended, found.refused) == (0, 1)
    assert found.summary().endswith("1 cross themselves and are left out (shapely splits them)")


@pytest.mark.parametrize(
    ("polygon", "crossed"),
    [
        ((SQUARE,), False),
        ((SQUARE, HOLE), False),
        ((SQUARE, HOLE + np.array([6.0, 0.0])), False),
        ((SQUARE, HOLE + np.array([13.0, 0.0])), True),
        ((BOW,), True),
        ((HORSESHOE,), False),
    ],
)
def test_crossing_is_what_geos_finds(polygon, crossed):
    shapely = pytest.importorskip("shapely", reason="needs shapely")
    assert rings.cross(polygon) is crossed
    assert shapely.Polygon(polygon[0], polygon[1:]).is_valid is not crossed


def test_rings_are_directed_and_middles_lie_inside():
    outer, hole = rings.directed((SQUARE[::-1], HOLE[::-1]))
    assert area(outer) == 200.0
    assert area(hole) == -16.0
    assert rings.middle((SQUARE,), np.empty((0, 2))) == pytest.approx((10.0, 5.0))
    centre = rings.middle((HORSESHOE,), rings.spread((HORSESHOE,), (3.0, 3.0)))
    assert inside((HORSESHOE,), centre[None])[0]


def slope(place):
    """A hillside with a pit that no corner of an outline sees, m."""
    pit = 6.0 * (np.hypot(place[:, 0] - 14.0, place[:, 1] - 5.0) < 2.0)
    return 100.0 + 0.8 * place[:, 0] - pit


def test_walls_begin_below_all_ground_and_the_roof_is_level_above_all_ground():
    (low, high) = buildings.place_on_ground(
        [buildings.Footprint(SQUARE, (), 3.0), buildings.Footprint(SQUARE, (), 30.0)], slope
    )
    dense = slope(np.stack(np.meshgrid(np.linspace(0, 20, 81), np.linspace(0, 10, 41)), -1).reshape(-1, 2))
    for each in (low, high):
        assert each.base == pytest.approx(dense.min() - placement.SKIRT, abs=0.81)
        assert each.base < dense.min()
    assert low.roof == pytest.approx(116.0 + 1.0)  # above the highest ground
    assert high.roof == pytest.approx(108.0 + 30.0)  # above the ground at the middle
    assert high.middle == pytest.approx((10.0, 5.0))


def test_a_pit_within_the_footprint_is_found():
    (building,) = buildings.place_on_ground(
        [buildings.Footprint(SQUARE, (), 9.0)],
        lambda at: 50.0 - 8.0 * (np.hypot(at[:, 0] - 14.0, at[:, 1] - 5.0) < 3.0),
    )
    assert building.base == pytest.approx(42.0 - placement.SKIRT)


def test_nothing_stands_nowhere():
    assert buildings.place_on_ground([], slope) == []


@pytest.mark.parametrize("holes", [(), (HOLE,)])
def test_a_block_is_closed_but_for_its_base(holes):
    pytest.importorskip("shapely", reason="needs shapely")
    (building,) = buildings.place_on_ground(
        [buildings.Footprint(SQUARE, holes, 6.0)], lambda at: 0.0 * at[:, 0]
    )
    corners, roof = blocks.block(building)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    keys = [tuple(map(tuple, each)) for each in edges.tolist()]
    open_ = [a for a in keys if a[::-1] not in keys]
    assert len(open_) == 4 * (1 + len(holes))
    assert all(start[2] == end[2] == building.base for start, end in open_)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.all(normal[roof, 2] > 0.0)
    assert np.all(normal[~roof, 2] == 0.0)
    assert 0.5 * normal[roof, 2].sum() == pytest.approx(200.0 - 16.0 * len(holes))
    # volume by the divergence theorem, with the base closed at its height
    volume = np.sum(np.einsum("ij,ij->i", corners[:, 0], normal)) / 6.0
    volume -= building.base * (200.0 - 16.0 * len(holes)) / 3.0
    assert volume == pytest.approx((6.0 + placement.SKIRT) * (200.0 - 16.0 * len(holes)))


def write(path, *polygons):
    features = [
        {
            "type": "Feature",
            "properties": properties,
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        }
        for ring, properties in polygons
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))


def test_a_file_of_footprints_is_read(tmp_path):
    ring = (np.array([-120.5, 38.9]) + SQUARE * 1e-5).tolist()
    write(tmp_path / "a.geojson", (ring, {"height": "9 m"}), (ring, {"building:levels": 2}), (ring, {}))
    found = buildings.read(tmp_path / "a.geojson")
    assert [each.height for each in found.outlines] == pytest.approx([9.0, 2 * STOREY, ASSUMED])
    assert found.assumed == 1


def test_kml_is_read_by_the_same_reader(tmp_path):
    text = " ".join(f"{x},{y},0" for x, y in np.array([-120.5, 38.9]) + SQUARE * 1e-5)
    (tmp_path / "a.kml").write_text(
        '<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><ExtendedData><Data name="height"><value>11'
        f"</value></Data></ExtendedData><Polygon><outerBoundaryIs><LinearRing><coordinates>{text}"
        "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>"
    )
    (only,) = buildings.read(tmp_path / "a.kml").outlines
    assert only.height == 11.0


def test_files_without_footprints_are_refused(tmp_path):
    (tmp_path / "a.txt").write_text("x")
    with pytest.raises(InputError, match=r"cannot be read; files of observations and outlines end in"):
        buildings.read(tmp_path / "a.txt")
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1.0, 2.0]}}
    (tmp_path / "b.geojson").write_text(json.dumps(point))
    with pytest.raises(InputError, match="has no polygons; footprints of buildings are polygons"):
        buildings.read(tmp_path / "b.geojson")
