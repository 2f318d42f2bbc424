"""The camera for headsets: its path, its view, and metadata of its pictures and films."""

import struct
import zlib
from dataclasses import replace
from datetime import UTC, datetime
from xml.etree import ElementTree

import numpy as np
import pytest
from filmed import film
from firetwin.errors import InputError
from firetwin.render import fingerprint, spherical
from firetwin.run import opening as runs
from firetwin.shot.cameras import panorama
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.cameras.rigs.vr import Vr
from firetwin.shot.settings import Camera, Render, scene_file
from firetwin_core import sensor

PLACE = (38.904, -120.594)
KEY = CameraKey(0.0, *PLACE, 120.0, "point", 38.905, -120.593)


def shot_of(run, *cameras, resolution=(512, 512)):
    start = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
    return film(run, *cameras, start=start, frames=5, render=Render(resolution=resolution))


@pytest.fixture
def run(make_run):
    return runs.open(make_run())


# Its way.


def test_it_stands_upright_and_turned_to_its_target(run):
    shot = shot_of(run, Camera("vr", Vr(keys=(KEY,))))
    (view,) = shot.paths
    latitude, longitude, height = shot.local_frame.reverse(view.position)
    assert latitude == pytest.approx(PLACE[0])
    assert longitude == pytest.approx(PLACE[1])
    higher = shot.local_frame.forward(latitude, longitude, height + 1.0)
    np.testing.assert_allclose(view.rotation[:, :, 1], higher - view.position, atol=1e-6)  # up is plumb
    local = np.einsum("fj,fji->fi", view.target - view.position, view.rotation)
    assert local[:, 0] == pytest.approx(np.zeros(5), abs=1e-6)  # in the middle, from left to right
    assert (local[:, 1:] < -50.0).all()  # ahead of it, and under the horizon


def test_over_its_target_it_looks_north(run):
    down = replace(KEY, target_latitude=PLACE[0], target_longitude=PLACE[1])
    (view,) = shot_of(run, Camera("vr", Vr(keys=(down,)))).paths
    assert -view.rotation[0][:, 2] == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
    assert np.linalg.det(view.rotation[0]) == pytest.approx(1.0)


def test_it_flies_as_a_drone_with_its_keys_does(run):
    keys = (KEY, replace(KEY, at=1.0, latitude=38.901, height=5.0))
    flown, drone = shot_of(run, Camera("vr", Vr(keys=keys)), Camera("drone", Drone(keys=keys))).paths
    np.testing.assert_array_equal(flown.position, drone.position)


def test_its_files_hang_on_the_code_of_the_drone_too(run):
    shot = shot_of(run, Camera("vr", Vr(keys=(KEY,))), Camera("drone", Drone(keys=(KEY,))))
    made = {c: fingerprint.collect_inputs(shot.settings, {}, c, "rgb")["sources"] for c in ("vr", "drone")}
    assert {"shot/cameras/rigs/vr.py", "shot/cameras/rigs/drone.py"} <= set(made["vr"])
    assert "shot/cameras/rigs/vr.py" not in made["drone"]


# Its view.


def test_it_sees_to_all_sides_and_up_and_down(run):
    shot = shot_of(run, Camera("vr", Vr(keys=(KEY,))))
    (view,) = shot.paths
    rng = np.random.default_rng(1)
    away = rng.normal(size=(400, 3))
    away *= 60.0 / np.linalg.norm(away, axis=1, keepdims=True)
    place = view.position[0] + away
    assert shot.visibility.visible_mask(place, 0.5).all()
    assert not shot.visibility.visible_mask(place, 0.5, reach=50.0).any()


@pytest.mark.parametrize(("apart", "hidden"), [(0.065, True), (20.0, False)])
def test_hills_hide_nothing_from_eyes_far_apart(make_run, apart, hidden):
    ridge = np.zeros((4, 5), np.float32)
    ridge[:, 2] = 2000.0
    run = runs.open(make_run(elevation=ridge))
    low = replace(KEY, longitude=float(run.longitude[0]), latitude=float(run.latitude[2]), height=200.0)
    shot = shot_of(run, Camera("vr", Vr(apart, keys=(low,))))
    behind = shot.ground.point(float(run.latitude[2]), float(run.longitude[4]), 5.0)
    assert shot.visibility.visible_mask(behind, 1.0).tolist() == [not hidden]


def test_what_is_built_follows_the_pixels_of_each_camera(run):
    drone = Drone(36.0, keys=(KEY,))
    cameras = (
        Camera("small", replace(drone, focal_length=18.0)),
        Camera("large", drone, resolution=(4000, 2000)),
        Camera("map", Satellite(swath=5000.0), resolution=(100, 100)),
        Camera("vr", Vr(keys=(KEY,)), resolution=(2048, 2048)),
    )
    shot = shot_of(run, *cameras)
    assert [view.pixel for view in shot.paths] == pytest.approx(
        [2.0 / 512, 1.0 / 4000, 50.0, 2.0 * np.pi / 2048]
    )
    assert shot.pixel == pytest.approx((1.0 / 4000, 50.0))
    assert shot.for_camera("small").pixel == pytest.approx((2.0 / 512, np.inf))
    maps = shot_of(run, *cameras[2:3])  # its pixels are 50 m
    found = [
        maps.visibility.visible_mask([(0.0, 0.0, 1e4)], 10.0, pixel=pixel).tolist() for pixel in (40.0, 60.0)
    ]
    assert found == [[False], [True]]


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ('"cycles"', '"eevee"', 6, "is a panorama, which EEVEE cannot render; use Cycles"),
        ("[512, 512]", "[640, 360]", 5, "needs a square resolution, such as [2048, 2048]"),
        ("keys = ", "# ", 5, "has no [[cameras.keys]] and no track; one key puts it in a place"),
        ("interocular = 0.1", "interocular = -1", 8, "must be from 0 to 100"),
        ("interocular", 'passes = ["rgb", "fused"]\ninterocular', 8, "is a panorama and cannot record fused"),
    ],
)
def test_what_it_cannot_be_is_said(tmp_path, old, new, line, words):
    path = tmp_path / "scene.toml"
    scene = (
        '[render]\nengine = "cycles"\nresolution = [512, 512]\n\n[[cameras]]\nkind = "vr"\nname = "headset"\n'
        "interocular = 0.1\nkeys = [{ latitude = 38.9, longitude = -120.5 }]\n"
    )
    path.write_text(scene)
    assert scene_file.read(path).cameras[0].rig.interocular == 0.1
    path.write_text(scene.replace(old, new))
    with pytest.raises(InputError) as error:
        scene_file.read(path)
    assert words in str(error.value)
    assert error.value.line == line


# Directions of its pictures.


def test_pixels_of_two_eyes_are_where_the_picture_has_them():
    bearing, elevation = panorama.pixels(8, 8)
    along = panorama.direction(bearing, elevation)
    assert np.linalg.norm(along, axis=-1) == pytest.approx(1.0)
    assert (along[[0, 3, 4, 7], :, 1] > 0.0).tolist() == [[True] * 8, [False] * 8] * 2  # each eye: up, down
    assert (along[1, [0, 7], 2] > 0.8).all()  # behind
    assert (along[1, [3, 4], 2] < -0.8).all()  # ahead
    assert np.sign(along[1, [1, 6], 0]).tolist() == [-1.0, 1.0]  # left, right


# Metadata for players.


def test_a_still_says_how_it_is_to_be_shown(tmp_path):
    path = tmp_path / "still.png"
    picture = np.random.default_rng(0).random((64, 64, 3)).astype(np.float32)
    sensor.write_image(path, picture)
    before = np.asarray(sensor.read_image(path))
    spherical.still(path, (64, 64), -17.0)
    np.testing.assert_array_equal(sensor.read_image(path), before)
    data, place, texts = path.read_bytes(), 8, []
    while place < len(data):  # PNG, 5.3: length, type, data, CRC of type and data
        length, kind = struct.unpack_from(">I4s", data, place)
        body = data[place + 8 : place + 8 + length]
        assert struct.unpack_from(">I", data, place + 8 + length)[0] == zlib.crc32(kind + body)
        texts += [body] * (kind == b"iTXt")
        place += 12 + length
    (text,) = texts
    name, rest = text.split(b"\0", 1)
    assert name == b"XML:com.adobe.xmp"  # XMP part 3, 1.1.5
    assert rest[:4] == b"\0\0\0\0"  # not compressed, no language, no other name
    (description,) = ElementTree.fromstring(rest[4:].decode()).iter(
        "{http://www.w3.org/1999/02/22-rdf-syntax-ns#}Description"
    )
    pano = "{http://ns.google.com/photos/1.0/panorama/}"
    says = {
        name.removeprefix(pano): value for name, value in description.attrib.items() if name.startswith(pano)
    }
    assert says["ProjectionType"] == "equirectangular"
    assert float(says["PoseHeadingDegrees"]) == 343.0
    for side, size in (("Width", "64"), ("Height", "64")):
        assert says[f"FullPano{side}Pixels"] == says[f"CroppedAreaImage{side}Pixels"] == size
    assert description.attrib["{http://ns.google.com/videos/1.0/spherical/}StereoMode"] == "top-bottom"


def box(kind, *inside):
    body = b"".join(inside)
    return struct.pack(">I4s", 8 + len(body), kind) + body


CHUNKS = [b"first chunk", b"second", b"the third one"]


def movie(order, wide):
    """An MP4 of one track of `CHUNKS` with its boxes in this order, and another track of sound."""
    entry = box(b"avc1", bytes(78), box(b"avcC", b"\1dog"), box(b"pasp", struct.pack(">2I", 1, 1)))

    def track(entry, places):
        table = struct.pack(f">2I{len(places)}{'Q' if wide else 'I'}", 0, len(places), *places)
        described = box(b"stsd", struct.pack(">2I", 0, 1), entry)
        tables = box(b"stbl", described, box(b"co64" if wide else b"stco", table))
        return box(b"trak", box(b"tkhd", bytes(84)), box(b"mdia", box(b"minf", tables)))

    places = [0, 0, 0]
    for _ in range(2):  # the second time with the right places
        sound = box(b"mp4a", b"a sound of 28 bytes or other")
        moov = box(b"moov", box(b"mvhd", bytes(100)), track(entry, places), track(sound, places[:1]))
        parts = {b"ftyp": box(b"ftyp", b"isom"), b"moov": moov, b"mdat": box(b"mdat", *CHUNKS)}
        film = b"".join(parts[kind] for kind in order)
        places = [film.index(chunk) for chunk in CHUNKS]
    return film


def walk(data, start, end, path=()):
    """Path, first and last byte of the body of every box (ISO/IEC 14496-12, 4.2, and the headers of some)."""
    headers = {b"stsd": 8, b"avc1": 78}
    inner = {b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsd", b"avc1", b"sv3d", b"proj"}
    while start < end:
        length, kind = struct.unpack_from(">I4s", data, start)
        assert 8 <= length <= end - start, path
        here = (*path, kind.decode())
        yield here, start + 8, start + length
        if kind in inner:
            yield from walk(data, start + 8 + headers.get(kind, 0), start + length, here)
        start += length


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("order", [(b"ftyp", b"mdat", b"moov"), (b"ftyp", b"moov", b"mdat")])
def test_a_film_says_how_it_is_to_be_shown_and_keeps_its_chunks(tmp_path, order, wide):
    path = tmp_path / "film.mp4"
    path.write_bytes(movie(order, wide))
    for _ in range(2):  # once more changes nothing
        spherical.film(path)
        data = path.read_bytes()
        boxes = list(walk(data, 0, len(data)))
        entry = [where[-1] for where, *_ in boxes if where[-2:-1] == ("avc1",)]
        assert entry == ["avcC", "st3d", "sv3d", "pasp"]
        body = {where[-1]: data[start:end] for where, start, end in boxes}
        assert body["st3d"] == bytes([0, 0, 0, 0, 1])  # top-bottom
        inside = [where[where.index("sv3d") + 1 :] for where, *_ in boxes if "sv3d" in where]
        assert inside == [(), ("svhd",), ("proj",), ("proj", "prhd"), ("proj", "equi")]
        assert body["svhd"] == bytes(4) + b"Firetwin\0"
        assert (body["prhd"], body["equi"]) == (bytes(16), bytes(20))
        tables = [data[start:end] for where, start, end in boxes if where[-1] in ("stco", "co64")]
        for table, count in zip(tables, (3, 1), strict=True):
            places = struct.unpack(f">{count}{'Q' if wide else 'I'}", table[8:])
            for at, chunk in zip(places, CHUNKS, strict=False):
                assert data[at : at + len(chunk)] == chunk


def test_a_film_of_something_else_stays_as_it_is(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(before := movie((b"ftyp", b"mdat", b"moov"), False).replace(b"avc1", b"av01"))
    with pytest.raises(InputError, match=r"no H\.264"):
        spherical.film(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
