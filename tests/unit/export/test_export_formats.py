"""KMZ and CZML of a small shot: other libraries read them, and positions agree in Earth-centred metres."""

import json
import xml.etree.ElementTree as ET
import zipfile
from datetime import datetime

import numpy as np
import pytest
from firetwin import cli
from firetwin.export import czml, fronts, kmz, overlays, symbols, texts, tracks
from firetwin.export.request import ExportRequest
from firetwin.run.front import reach
from firetwin.shot import georeference
from firetwin.shot.source import ShotSource
from PIL import Image
from pyproj import Geod, Transformer
from scipy.interpolate import RegularGridInterpolator
from small_run import RUN_TOML

HOSTILE = """A "quoted" <name> & 'more' 🔥"""
SCENE = """\
run = "run"
[time]
start = 2014-09-17T04:45:30Z
end = 2014-09-17T04:47:00Z
frames = 4
[terrain]
near_radius = 0.0
[tiles]
geoid = -24.9
[labels]
enabled = true
file = "places.csv"
[[cameras]]
name = "drone"
keys = [
  { at = 0.0, latitude = 38.905, longitude = -120.59, height = 400, target = "fire" },
  { at = 1.0, latitude = 38.9, longitude = -120.6, height = 300, target = "fire" },
]
[[cameras]]
name = "late"
frames = "3-4"
keys = [{ latitude = 38.903, longitude = -120.58, height = 500, target = "fire" }]
"""
KML = "{http://www.opengis.net/kml/2.2}"
GX = "{http://www.google.com/kml/ext/2.2}"
FROM_GEODETIC = Transformer.from_crs(4979, 4978)
GEODESIC = Geod(ellps="WGS84")
NAME = RUN_TOML.replace('name = "Small"', "name = " + json.dumps(HOSTILE * 12 + "\\n", ensure_ascii=False))


@pytest.fixture
def scene(make_run, tmp_path):
    rows, columns = np.ogrid[:8, :10]
    arrival = (30.0 * np.hypot(rows - 3.6, columns - 4.3)).astype(np.float32)
    make_run(toml=NAME, fuel_arrival_time=arrival)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    quoted = HOSTILE.replace('"', '""')
    (tmp_path / "places.csv").write_text(f'name,latitude,longitude\n"{quoted}",38.903,-120.592\n')
    return path


@pytest.fixture
def request_of(scene, tmp_path):
    """Return a function that makes the request of a format: request_of(frames)."""

    def make(*frames):
        folder = tmp_path / "made"
        folder.mkdir(exist_ok=True)
        return ExportRequest(ShotSource(scene=str(scene)), "kmz", folder, ",".join(map(str, frames)))

    return make


def kml_document(request):
    (path,) = kmz.write(request)
    with zipfile.ZipFile(path) as archive:
        return archive.read("doc.kml"), {name: archive.read(name) for name in archive.namelist()}


def packets(request):
    (path,) = czml.write(request)
    return json.loads(path.read_text(encoding="utf-8"))


def by_proj(shot, position):
    """Convert scene positions to Earth-centred metres by PROJ alone."""
    pipeline = (
        f"+proj=pipeline +step +inv +proj=topocentric +lat_0={shot.local_frame.latitude!r} "
        f"+lon_0={shot.local_frame.longitude!r} +h_0=0 +ellps=WGS84 +step +inv +proj=cart +ellps=WGS84 "
        "+step +proj=affine +zoff=-24.9 +step +proj=cart +ellps=WGS84"
    )
    return np.transpose(Transformer.from_pipeline(pipeline).transform(*position.T))


def test_a_camera_of_czml_is_where_proj_puts_it(request_of):
    request = request_of()
    shot, (camera, late) = request.shot, [p for p in packets(request) if p["id"].startswith("camera")]
    samples = np.reshape(camera["position"]["cartesian"], (-1, 4))
    np.testing.assert_allclose(samples[:, 0], [0.0, 30.0, 60.0, 90.0])
    np.testing.assert_allclose(samples[:, 1:], by_proj(shot, shot.paths[0].position), atol=0.01)
    assert camera["position"]["epoch"] == "2014-09-17T04:45:30Z"
    assert late["availability"] == "2014-09-17T04:46:30Z/2014-09-17T04:47:00Z"


def test_a_camera_of_czml_looks_along_its_x_axis(request_of):
    request = request_of()
    path = request.shot.paths[0]
    camera = next(p for p in packets(request) if p["id"] == "camera-1")
    x, y, z, w = np.reshape(camera["orientation"]["unitQuaternion"], (-1, 5))[:, 1:].T
    forward = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)], axis=-1)
    up = np.stack([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)], axis=-1)
    step = 100.0
    ahead = by_proj(request.shot, path.position - step * path.rotation[:, :, 2])
    here = by_proj(request.shot, path.position)
    above = by_proj(request.shot, path.position + step * path.rotation[:, :, 1])
    np.testing.assert_allclose(forward, (ahead - here) / step, atol=1e-5)
    np.testing.assert_allclose(up, (above - here) / step, atol=1e-5)
    (angle, *_) = np.reshape(camera["properties"]["horizontalFieldOfView"]["number"], (-1, 2))[:, 1]
    assert angle == pytest.approx(2 * np.degrees(np.arctan(path.half[0])), abs=1e-4)


def test_a_camera_of_kml_is_where_proj_puts_it(request_of):
    """KML's altitude is above sea level: EGM96 is the geoid of the scene, -24.9 m."""
    request = request_of()
    text, _ = kml_document(request)
    tour = ET.fromstring(text).find(f".//{GX}Tour")
    cameras = tour.findall(f".//{KML}Camera")
    values = np.array(
        [[float(c.findtext(KML + key)) for key in ("latitude", "longitude", "altitude")] for c in cameras]
    )
    here = np.transpose(FROM_GEODETIC.transform(*values.T[:2], values[:, 2] - 24.9))
    np.testing.assert_allclose(here, by_proj(request.shot, request.shot.paths[0].position), atol=0.01)
    assert [float(each.text) for each in tour.findall(f".//{GX}duration")] == [
        3.0,
        *[pytest.approx(1 / 24, rel=1e-4)] * 3,
    ]
    assert cameras[1].findtext(f"{GX}TimeStamp/{KML}when") == "2014-09-17T04:46:00Z"


def test_angles_of_kml_give_the_direction_of_view(request_of):
    request = request_of()
    path = request.shot.paths[0]
    track = tracks.find(request)[0]
    heading, tilt, roll = track.angles(request.georeference.matrix[:3, :3])
    latitude, longitude = track.geodetic[:, :2].T
    ahead = path.position - 1000.0 * path.rotation[:, :, 2]
    there = request.georeference.geodetic(ahead)
    expected, _, _ = GEODESIC.inv(longitude, latitude, there[:, 1], there[:, 0])
    np.testing.assert_allclose((heading - expected + 180) % 360 - 180, 0.0, atol=0.01)
    fall = (track.geodetic[:, 2] - there[:, 2]) / 1000.0
    np.testing.assert_allclose(tilt, np.degrees(np.arccos(fall)), atol=0.01)
    np.testing.assert_allclose(roll, 0.0, atol=0.02)


def test_roll_is_positive_if_the_right_side_is_lower(request_of):
    request = request_of(1)
    track = tracks.find(request)[0]
    c, s = np.cos(np.radians(10.0)), np.sin(np.radians(10.0))
    rolled = track.rotation @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    assert rolled[0, 2, 0] < track.rotation[0, 2, 0]
    found = type(track)(**(vars(track) | {"rotation": rolled}))
    _, _, roll = found.angles(request.georeference.matrix[:3, :3])
    assert roll[0] == pytest.approx(10.0, abs=0.05)
    down = np.array([[[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]])
    origin = request.georeference.geodetic(np.zeros(3))
    straight = type(track)(**(vars(track) | {"rotation": down, "geodetic": origin}))
    heading, tilt, roll = straight.angles(request.georeference.matrix[:3, :3])
    assert heading[0] == pytest.approx(350.0, abs=0.05)
    assert (tilt[0], roll[0]) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_fronts_are_on_the_contour_of_the_arrival_times_in_both_formats(request_of):
    request = request_of()
    text, _ = kml_document(request)
    marks = ET.fromstring(text).findall(f".//{KML}Placemark[{KML}MultiGeometry]")
    drawn = [p for p in packets(request) if p["id"].startswith("front")]
    found = fronts.find(request)
    assert len(marks) == len(found) >= 2
    front = found[-1]
    fire = reach(request.shot.run)
    rings = [
        np.array([point.split(",") for point in ring.text.split()], float)
        for ring in marks[-1].iterfind(f".//{KML}coordinates")
    ]
    assert sum(map(len, rings)) == sum(map(len, front.lines)) > 6
    run = request.shot.run
    axes = run.fuel_latitude, run.fuel_longitude
    arrival = RegularGridInterpolator(axes, run.fuel_arrival_time(), bounds_error=False)
    for ring in rings:
        late = arrival(ring[:, ::-1]) - front.time  # 30 s in 170 m: 1 cm is 0.0018 s
        assert np.isfinite(late).sum() >= 4  # others are at the border of the grid
        assert np.nanmax(np.abs(late)) < 0.0018
        for side in (0.98, 1.02):  # burned inside, not outside
            about = ring.mean(axis=0) + side * (ring - ring.mean(axis=0))
            assert np.mean(fire.burned(about[:, 1], about[:, 0], front.time) == (side < 1)) > 0.6
    outer = np.reshape(drawn[-1]["polyline"]["positions"]["cartographicDegrees"], (-1, 3))
    kml_ring = rings[0]
    a, b = (
        FROM_GEODETIC.transform(ring[:, 1], ring[:, 0], np.zeros(len(ring))) for ring in (outer, kml_ring)
    )
    np.testing.assert_allclose(a, b, atol=0.01)
    begin, end = (marks[-2].findtext(f"{KML}TimeSpan/{KML}{key}") for key in ("begin", "end"))
    assert end == marks[-1].findtext(f"{KML}TimeSpan/{KML}begin") == texts.iso(front.begin)
    assert datetime.fromisoformat(begin) < datetime.fromisoformat(end)


def test_holes_belong_to_the_smallest_ring_around_them():
    def square(size, clockwise=False):
        ring = size * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]], float)
        return ring[::-1] if clockwise else ring

    lake, island, pond = square(3.0, clockwise=True), square(2.0), square(1.0, clockwise=True)
    found = fronts.polygons([pond, square(5.0), island, lake, square(1.0) + 20.0])
    assert [[float(np.ptp(ring)) for ring in polygon] for polygon in found] == [[10, 6], [4, 2], [2]]


def test_a_ground_overlay_has_each_cell_at_its_place(request_of):
    run = request_of().shot.run
    arrival, _ = overlays.draw(run)
    rows, columns = arrival.pixels.shape[:2]
    row = (arrival.north - run.fuel_latitude) / (arrival.north - arrival.south) * rows
    column = (run.fuel_longitude - arrival.west) / (arrival.east - arrival.west) * columns
    shown = arrival.pixels[np.ix_(row.astype(int), column.astype(int))][..., 3] > 0
    np.testing.assert_array_equal(shown, run.fuel_arrival_time() <= run.times[-1])
    assert 0 < shown.sum() < shown.size


def test_names_of_users_stay_names(request_of):
    request = request_of()
    text, _ = kml_document(request)
    root = ET.fromstring(text)
    names = [each.text for each in root.iter(f"{KML}name")]
    assert HOSTILE in names
    assert root.findtext(f"{KML}Document/{KML}name").startswith(HOSTILE)
    found = {packet["name"] for packet in packets(request) if "name" in packet}
    assert HOSTILE in found


def test_forbidden_characters_of_xml_are_left_out():
    assert texts.xml('a\x00\x1b\ud800\ufffe<&"\n') == "a&lt;&amp;&quot;\n"


def test_pictures_are_read_by_pillow(request_of, tmp_path):
    _, members = kml_document(request_of())
    for name, data in members.items():
        if name.endswith(".png"):
            path = tmp_path / "picture.png"
            path.write_bytes(data)
            with Image.open(path) as picture:
                picture.load()
                assert picture.mode == "RGBA"
    pixels = symbols.draw("#ff0000", cross="#ff0000")
    assert pixels[32, 32].tolist() == [255, 0, 0, 255]
    assert pixels[0, 0, 3] == 0


def test_czml3_reads_all_packets(request_of):
    read = pytest.importorskip("czml3").Packet
    for packet in packets(request_of()):
        read.model_validate(packet)


def test_the_kml_is_valid_by_its_schema(request_of):
    fastkml = pytest.importorskip("fastkml")
    etree = pytest.importorskip("lxml.etree")
    from pathlib import Path

    text, _ = kml_document(request_of())
    schema = etree.XMLSchema(etree.parse(Path(fastkml.__file__).parent / "schema" / "kml22gx.xsd"))
    schema.assertValid(etree.fromstring(text))


@pytest.mark.parametrize("name", ["kmz", "czml"])
def test_the_command_lists_its_files(name, scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert cli.main(["export", str(scene), "--to", name, "--out", str(out), "--frames", "1-4:3"]) == 0
    assert capsys.readouterr().out.split() == [str(out / f"scene.{name}"), str(out / "georeference.json")]
    assert cli.main(["export", str(scene), "--to", name, "--out", str(out), "--frames", "1-9"]) == 2
    assert "--frames" in capsys.readouterr().err


def test_heights_of_tiles_are_refused_by_the_name_of_their_terms(scene, tmp_path, capsys):
    """Cameras are placed above the ground, which is of the tiles; nothing is requested from the server."""
    text = SCENE.replace("near_radius = 0.0", 'near_radius = 0.0\nheight_source = "tiles"')
    source = 'vegetation = "tileset"\nsources = ["https://tile.googleapis.com/v1/3dtiles/root.json"]\n'
    text = text.replace("geoid = -24.9\n", "geoid = -24.9\n" + source).replace(
        "enabled = true", "enabled = false"
    )
    scene.write_text(text)
    out = tmp_path / "out"
    assert cli.main(["export", str(scene), "--to", "kmz", "--out", str(out)]) == 1
    said = capsys.readouterr().err
    assert "Google" in said
    assert "does not allow" in said
    assert not out.exists()


def test_without_a_geoid_the_command_says_so_loudly(scene, tmp_path, capsys, monkeypatch):
    scene.write_text(SCENE.replace("geoid = -24.9", ""))
    monkeypatch.setattr(georeference.geoid, "find", lambda: None)
    assert cli.main(["export", str(scene), "--to", "czml", "--out", str(tmp_path / "out")]) == 0
    assert "warning: the height of the geoid is unknown" in capsys.readouterr().err
