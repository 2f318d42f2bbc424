"""Tags of EXR files: values against closed forms, and types by the OpenEXR library's Python module."""

from datetime import UTC, datetime, timedelta
from fractions import Fraction
from types import SimpleNamespace

import made_up_film
import numpy as np
import pytest
from firetwin import timecode
from firetwin.render import timecode_track
from firetwin.shot import exr_tags, picture_credits
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.path import Path
from firetwin.shot.settings import Render
from firetwin_core import geo, sensor


def view(**changes):
    """A camera that looks north-east and down, at (300, -200, 900) m."""
    back = np.array([-1.0, -1.0, 0.7]) / np.sqrt(2.49)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    turn = np.stack([right, np.cross(back, right), back], axis=-1)
    camera = SimpleNamespace(name="drone")
    place = np.array([[300.0, -200.0, 900.0]])
    return Path(camera, place, turn[None], np.zeros((1, 3)), (0.6, 0.3), **changes)


@pytest.fixture
def shot(monkeypatch):
    monkeypatch.setattr(picture_credits, "of_shot", lambda _: SimpleNamespace(data=["Tiles: A", "B"]))
    start = datetime(2014, 9, 17, 23, 12, tzinfo=UTC)
    return SimpleNamespace(
        paths=[view()],
        run=SimpleNamespace(name="King", synthetic=True),
        settings=SimpleNamespace(
            render=Render(exr_space="acescg"),
            time=SimpleNamespace(zone="America/Los_Angeles", rate=Fraction(24)),
        ),
        local_frame=geo.LocalFrame(38.8, -120.6, 1000.0),
        utc=lambda frame: start + timedelta(seconds=60 * (frame - 1)),
    )


def test_tags_of_a_frame(shot, tmp_path):
    openexr = pytest.importorskip("OpenEXR")
    exr_tags.write_radiance(tmp_path / "a.exr", np.full((4, 8, 3), 0.5, np.float32), shot, "drone", 1, 4.25)
    header = openexr.File(str(tmp_path / "a.exr")).header()
    expected = {
        "colorInteropID": "lin_ap1_scene",
        "comments": "Firetwin: King (synthetic); scene-linear radiance",
        "owner": "Tiles: A; B",
        "capDate": "2014:09:17 16:12:00",
        "utcOffset": 7 * 3600.0,
        "cameraLabel": "drone",
        "imageCounter": 1,
        "exposureStops": 4.25,
        "worldOrigin": "38.8 -120.6 1000.0",
        "framesPerSecond": Fraction(24),
        "pinholeFocalLength": pytest.approx(18.0 / 0.6),
    }
    assert {name: header[name] for name in expected} == expected
    assert header["Software"].startswith("Firetwin ")
    assert header["sensorOverallDimensions"] == pytest.approx([36.0, 18.0])
    assert [header[name] for name in ("latitude", "longitude", "altitude")] == pytest.approx(
        [38.8 - 200 / 110992, -120.6 + 300 / 86880, 1900.0], rel=1e-5
    )
    assert header["worldToCamera"].shape == header["worldToNDC"].shape == (4, 4)
    assert "chromaticities" not in header
    assert sensor.read_image(tmp_path / "a.exr")[0, 0] == pytest.approx([0.5] * 3, abs=5e-4)


def test_data_is_tagged_as_data(shot):
    tags = exr_tags.attributes(shot, "drone", 1)
    assert tags["colorInteropID"] == "data"
    assert "exposureStops" not in tags


@pytest.mark.parametrize("perspective", [True, False])
def test_matrices_lead_to_the_pixels(perspective):
    camera, depth = view(perspective=perspective), np.full((9, 16), 250.0)
    points = pixel_rays.points(camera, 1, depth).reshape(-1, 3)
    points = np.concatenate([points, np.ones((len(points), 1))], axis=-1)
    ahead = points @ exr_tags.world_to_camera(camera, 1)
    assert ahead[:, 2] == pytest.approx(250.0)
    picture = points @ exr_tags.world_to_ndc(camera, 1)
    picture = (picture / picture[:, 3:]).reshape(9, 16, 4)
    assert picture[..., 0] == pytest.approx(np.tile((np.arange(16) + 0.5) / 16, (9, 1)))
    assert picture[..., 1] == pytest.approx(np.tile((np.arange(9)[:, None] + 0.5) / 9, (1, 16)))


def test_a_panorama_has_no_picture_plane():
    assert set(exr_tags._lens(view(around=True), 1)) == {"worldToCamera"}


@pytest.mark.parametrize(
    ("fps", "frame", "rate", "numbers"),
    [
        (24, 1, Fraction(24), (1, 0, 0, 0, 0, 0)),
        (24, 24 * 61 + 6, Fraction(24), (1, 1, 1, 5, 0, 0)),
        (23.976, 48, Fraction(24000, 1001), (1, 0, 1, 23, 0, 0)),
        (29.97, 1801, Fraction(30000, 1001), (1, 1, 0, 2, 0, 1)),
        (60, 64, Fraction(60), (1, 0, 1, 1, 1, 0)),
        (59.94, 3602, Fraction(60000, 1001), (1, 1, 0, 2, 1, 1)),
    ],
)
def test_film_time(tmp_path, fps, frame, rate, numbers):
    openexr = pytest.importorskip("OpenEXR")
    tags = exr_tags.film_time(timecode.exact_rate(fps), frame)
    sensor.write_image(tmp_path / "a.exr", np.zeros((2, 2)), tags)
    found = openexr.File(str(tmp_path / "a.exr")).header()
    code = found["timeCode"]
    assert found["framesPerSecond"] == rate
    shown = (code.hours, code.minutes, code.seconds, code.frame, code.fieldPhase, code.dropFrame)
    assert shown == numbers


@pytest.mark.parametrize("fps", [24, 23.976, 29.97])
@pytest.mark.parametrize("frame", [1, 1801, 17_983])
def test_tags_agree_with_the_timecode_track_of_the_film(tmp_path, monkeypatch, fps, frame):
    """The track is read by its fields in the QuickTime File Format Specification."""
    rate, codes = timecode.exact_rate(fps), []
    monkeypatch.setattr(sensor, "TimeCode", lambda *numbers, **marks: codes.append((numbers, marks)))
    exr_tags.film_time(rate, frame)
    ((numbers, marks),) = codes
    film = tmp_path / "film.mp4"
    made_up_film.write(film)
    timecode_track.add(film, timecode.count_of_frame(frame, rate), rate)
    first, flags, counted = made_up_film.read_timecode(film)
    assert bool(flags & 1) == marks["drop_frame"]
    assert counted == round(fps)
    assert timecode.components(first, rate) == numbers


def test_very_fast_films_have_no_time_code():
    assert exr_tags.film_time(Fraction(120), 5) == {"framesPerSecond": Fraction(120)}


def test_the_matrix_follows_from_the_primaries():
    def to_xyz(primaries, white):
        xyz = np.array([[x / y, 1.0, (1.0 - x - y) / y] for x, y in (*primaries, white)]).T
        return xyz[:, :3] * np.linalg.solve(xyz[:, :3], xyz[:, 3]), xyz[:, 3]

    # ITU-R BT.709-6 and the Academy's TB-2014-004
    rec709, d65 = to_xyz([(0.64, 0.33), (0.3, 0.6), (0.15, 0.06)], (0.3127, 0.329))
    ap1, d60 = to_xyz([(0.713, 0.293), (0.165, 0.83), (0.128, 0.044)], (0.32168, 0.33767))
    cone = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
    adapted = np.linalg.solve(cone, np.diag(cone @ d60 / (cone @ d65)) @ cone)
    expected = np.linalg.solve(ap1, adapted @ rec709)
    assert expected == pytest.approx(exr_tags.AP1_FROM_REC709, abs=2e-6)
    light = np.random.default_rng(5).random((3, 4, 3), np.float32)
    assert exr_tags.to_exr_space(light, "rec709") is light
    assert exr_tags.to_exr_space(light, "acescg") == pytest.approx(light @ expected.T, abs=1e-5)
