"""Infrared flights' maps: their classes as NIFC's layers name them, from every format."""

import json
import zipfile
from datetime import UTC, datetime

import geopackage_file
import numpy as np
import pytest
from fires import closed, square
from firetwin import cli
from firetwin.run import observations
from firetwin.run.observations import infrared_detections
from firetwin.run.observations.feature import Feature

RING = square(1000.0)
FLOWN = "2014-09-18T06:30:00Z"
AREAS = (
    *("IR Heat Perimeter", "IR Intense Heat", "IR Scattered Heat"),
    *("Area Covered by IR Flight", "Cloud Cover"),
)
SPOTS = (
    ("IR Isolated Heat Source", (-120.6, 38.9)),
    ("IR Isolated Heat Source", (-120.59, 38.91)),
    ("Possible IR Heat Source", (-120.58, 38.9)),
)


def geojson(folder):
    def feature(name, time, geometry):
        return {"type": "Feature", "properties": {"FeatureCategory": name, time: FLOWN}, "geometry": geometry}

    polygon = {"type": "Polygon", "coordinates": [closed(RING)]}
    features = [feature(name, "PolygonDateTime", polygon) for name in AREAS]
    for name, spot in SPOTS:
        features.append(feature(name, "PointDateTime", {"type": "Point", "coordinates": [*spot, 1200.0]}))
    path = folder / "ir.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return [path]


def kmz(folder):
    """Folders say the class, as interpreters lay them out; one time for all."""
    text = " ".join(f"{x},{y},0" for x, y in RING)
    ring = f"<LinearRing><coordinates>{text}</coordinates></LinearRing>"
    shapes = [(name, f"<Polygon><outerBoundaryIs>{ring}</outerBoundaryIs></Polygon>") for name in AREAS]
    shapes += [(name, f"<Point><coordinates>\n {x},{y},0\n</coordinates></Point>") for name, (x, y) in SPOTS]
    parts = "".join(
        f"<Folder><name>{name}</name><Placemark><name>{i}</name>{shape}</Placemark></Folder>"
        for i, (name, shape) in enumerate(shapes)
    )
    whole = f"<kml><Document><TimeStamp><when>{FLOWN}</when></TimeStamp>{parts}</Document></kml>"
    with zipfile.ZipFile(folder / "ir.kmz", "w") as archive:
        archive.writestr("doc.kml", whole)
    return [folder / "ir.kmz"]


def shapefiles(folder):
    """One file each for areas and points; of names ten letters are left."""
    import shapefile as pyshp
    from pyproj import CRS

    kinds = (
        ("area", pyshp.POLYGON, "PolygonDat", [(name, RING) for name in AREAS]),
        ("point", pyshp.POINT, "PointDateT", SPOTS),
    )
    for stem, kind, time, shapes in kinds:
        with pyshp.Writer(str(folder / stem), kind) as writer:
            writer.field("FeatureCat", "C", 40)
            writer.field(time, "C", 30)
            for name, shape in shapes:
                writer.point(*shape) if kind == pyshp.POINT else writer.poly([closed(shape)[::-1]])
                writer.record(name, FLOWN)
        (folder / f"{stem}.prj").write_text(CRS("EPSG:4326").to_wkt("WKT1_ESRI"))
    return [folder / "area.shp", folder / "point.shp"]


def geopackage(folder):
    """A layer of areas and one of points."""
    area = geopackage_file.polygon(closed(RING))
    areas = [(area, FLOWN, name) for name in AREAS]
    points = [(geopackage_file.point(*spot), FLOWN, name) for name, spot in SPOTS]
    columns = ["date_time", "FeatureCategory"]
    return [geopackage_file.write(folder / "ir.gpkg", columns, areas=areas, points=points)]


@pytest.mark.parametrize("make", [geojson, kmz, shapefiles, geopackage])
def test_an_infrared_flight_is_read_by_its_classes(tmp_path, make):
    """Its perimeter alone is one; heat has its class; where it flew and clouds are neither."""
    flight = observations.read(make(tmp_path))
    (perimeter,) = flight.perimeters
    assert len(perimeter.polygons) == 1
    kinds = {each.kind: each for each in flight.heat}
    assert set(kinds) == set(infrared_detections.KINDS)
    moments = {perimeter.time, *(each.time for each in flight.heat)}
    assert moments == {datetime(2014, 9, 18, 6, 30, tzinfo=UTC)}
    for kind in ("intense", "scattered"):
        ((ring,),) = kinds[kind].polygons
        np.testing.assert_allclose(ring.mean(axis=0), RING.mean(axis=0), atol=1e-9)
        assert not len(kinds[kind].points)
    np.testing.assert_array_equal(kinds["isolated"].points, [spot for _, spot in SPOTS[:2]])
    np.testing.assert_array_equal(kinds["possible"].points, [SPOTS[2][1]])
    assert any("2 features that are neither perimeter nor heat" in each for each in flight.assumptions)


@pytest.mark.parametrize(
    ("stem", "properties", "kind"),
    [
        ("20140918_King_Intense", {}, "intense"),
        ("20140918_King_Isolated", {}, "isolated"),
        ("20140918_King_IR_HeatPerimeter", {}, "perimeter"),
        ("king", {"name": "Isolated Heat"}, "isolated"),
        ("king", {"name": "Isolated Peak Fire"}, ""),
        ("king", {"Type": "Heat Perimeter", "name": "Intense Heat"}, "perimeter"),
        ("king", {}, ""),
    ],
)
def test_classes_by_name(tmp_path, stem, properties, kind):
    assert infrared_detections.kind(tmp_path / f"{stem}.shp", Feature((), properties)) == kind


def test_heat_is_drawn_by_class_until_the_next_flight(make_run, tmp_path):
    from firetwin.run import maps, readers
    from firetwin.shot.source import ShotSource
    from firetwin.shot.surface import observed

    run = make_run()
    corners = [[-120.595, 38.903], [-120.590, 38.903], [-120.590, 38.907], [-120.595, 38.903]]
    hole = [[-120.592, 38.9033], [-120.5905, 38.9033], [-120.5905, 38.9045], [-120.592, 38.9033]]
    features = [
        {"type": "Feature", "properties": {"class": name, "time": f"2014-09-17T04:{minute}:30Z"},
         "geometry": {"type": "Polygon", "coordinates": rings} if rings
         else {"type": "Point", "coordinates": [-120.592, 38.905]}}
        for name, minute, rings in (
            ("Intense Heat", 45, [corners, hole]),
            ("Isolated Heat", 45, []),
            ("Scattered Heat", 46, [corners]),
        )
    ]  # fmt: skip
    path = tmp_path / "ir.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    scene = tmp_path / "scene.toml"
    scene.write_text(f'run = "{run.as_posix()}"\n[terrain]\napron = 0.0\n[fire]\nobserved = "ir.geojson"\n')
    lines = observed.lines(ShotSource(scene=str(scene)).shot())
    assert [(line.kind, line.start, line.end) for line in lines] == [
        ("intense", 30.0, 90.0),
        ("intense", 30.0, 90.0),  # its hole
        ("isolated", 30.0, 90.0),
        ("scattered", 90.0, 90.0 + 24 * 3600.0),
    ]
    assert np.ptp(lines[2].points[:, 0]) == pytest.approx(120.0, rel=0.05)  # 1.5 widths each way
    (axes, *_) = maps.intensity_map(readers.open(run), "UTC", observations.read([path])).axes
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["intense heat", "scattered heat", "isolated heat"]
    intense = next(each for each in axes.patches if each.get_label() == "intense heat")
    rings = [ring.T - ring[:1].T for ring in intense.get_path().to_polygons()]
    turns = [np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) for x, y in rings]
    assert turns[0] > 0 > turns[1]  # the hole is one


def test_heat_alone_is_nothing_to_compare_with(make_run, tmp_path, capsys):
    path = tmp_path / "ir.geojson"
    spot = {"type": "Point", "coordinates": [-120.592, 38.905]}
    path.write_text(
        json.dumps({"type": "Feature", "properties": {"class": "isolated", "time": FLOWN}, "geometry": spot})
    )
    assert cli.main(["score", str(make_run()), "--against", str(path)]) == 1
    assert "ir.geojson: has detections but no perimeter" in capsys.readouterr().err
