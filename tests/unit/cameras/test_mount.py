"""Sensors on one mount, masks, sidecars and the index of a shot that trains."""

import json
from dataclasses import replace

import numpy as np
import pytest
from firetwin.errors import InputError, UsageError
from firetwin.imaging import sheet as _sheet
from firetwin.passes import _map, masks, pose
from firetwin.passes import fused as fused_pass
from firetwin.render import dataset, fingerprint, plan, verify
from firetwin.render.picture import Picture
from firetwin.render.store import Store, describe
from firetwin.run import info
from firetwin.run import opening as runs
from firetwin.shot import exr_tags, passes
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.lookout import Lookout, LookoutKey
from firetwin.shot.cameras.rigs.minimap import Minimap
from firetwin.shot.cameras.rigs.mounted import Mounted
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.sections import TerrainSettings, Time
from firetwin.shot.settings import Camera, Render, Settings, mount, scene_file
from firetwin.shot.shot import Shot
from firetwin_core import sensor

KEYS = (
    CameraKey(0.0, 38.900, -120.599, 300.0, "point", 38.904, -120.593),
    CameraKey(1.0, 38.908, -120.587, 250.0, "point", 38.904, -120.593),
)
DRONE = Camera("drone", Drone(keys=KEYS, vibration=0.5, bank=1.0))
SCENE = (
    '[[cameras]]\nname = "drone"\n[[cameras.keys]]\nat = 0.0\n[[cameras]]\nkind = "mounted"\nname = "two"\n'
)


@pytest.fixture
def shot(make_run):
    def make(*cameras):
        ground = TerrainSettings(near_radius=0.0, apron=5000.0)
        render = Render(resolution=(320, 180))
        settings = Settings(time=Time(frames=5), terrain=ground, cameras=cameras, render=render)
        return Shot(settings, runs.open(make_run()))

    return make


def test_sensors_of_a_mount_share_place_and_direction_in_every_frame(shot):
    narrow = Camera("narrow", Mounted("drone", 50.0, 13.2), resolution=(160, 128))
    made = shot(DRONE, Camera("same", Mounted("drone")), narrow)
    drone, same, narrow = (made.for_camera(name).paths[0] for name in ("drone", "same", "narrow"))
    for other in (same, narrow):  # also where the others are not filmed
        assert np.array_equal(other.position, drone.position)
        assert np.array_equal(other.rotation, drone.rotation)
    assert same.half == drone.half
    assert narrow.half == pytest.approx((0.132, 0.132 * 128 / 160))
    assert narrow.sensor == 13.2


def test_a_sensor_without_a_lens_zooms_with_its_mount(shot):
    keys = (LookoutKey(0.0), LookoutKey(1.0, zoom=4.0))
    tower = Camera("tower", Lookout(latitude=38.904, longitude=-120.593, keys=keys))
    made = shot(tower, Camera("same", Mounted("tower")), Camera("fixed", Mounted("tower", 20.0)))
    tower, same, fixed = made.paths
    assert np.array_equal(same.halves, tower.halves)
    assert np.ptp(fixed.halves, axis=0) == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("", 'camera "two" has no follows; name the camera it is mounted with'),
        ('follows = "dorne"', 'follows "dorne", and no other camera has this name; did you mean "drone"?'),
        ('follows = "two"', 'follows "two", and no other'),
    ],
)
def test_a_mount_that_is_not_there_is_an_error(tmp_path, line, words):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE + line)
    with pytest.raises(InputError) as caught:
        scene_file.read(scene)
    assert words in caught.value.reason


def test_nothing_follows_what_follows_and_nothing_is_mounted_on_a_satellite():
    cameras = (Camera("two", Mounted("drone")), Camera("sat", Satellite()), DRONE)
    assert Minimap().followed(cameras[:1]) is None
    assert Minimap().followed(cameras[::2]) is DRONE
    assert Mounted("sat").followed(cameras) is None


def test_classes_and_numbers_survive_smoke_exactly():
    rng = np.random.default_rng(0)
    kind, number = rng.integers(0, 6, (40, 50)), rng.integers(0, 10_000_000, (40, 50))
    kind[kind == masks.SMOKE] = masks.TREE
    clear = rng.uniform(0.001, 1.0, kind.shape).astype(np.float32)
    code = np.stack([number % 4096, np.ones(kind.shape), kind + 8 * (number // 4096)], axis=-1)
    pixels = (code.astype(np.float32) * clear[..., None]).astype(np.float32)
    classes, instance, through, surface = masks.classes(pixels)
    assert np.array_equal(instance, number)
    assert np.array_equal(classes[clear > 0.5], kind[clear > 0.5])
    assert np.all(classes[clear < 0.5] == masks.SMOKE)
    assert np.array_equal(through, clear)
    assert np.array_equal(surface, kind)  # also behind smoke
    classes, instance, _, _ = masks.classes(np.zeros((2, 2, 3), np.float32))
    assert np.all(classes == masks.SMOKE)
    assert np.all(instance == 0)


def test_numbers_of_trees_are_theirs_and_whole_in_32_bits():
    bits = np.random.default_rng(2).integers(-(2**63), 2**63, 200_000)
    key = np.stack([bits >> 32, bits & 0xFFFFFFFF])
    found = masks.numbers(*key)
    assert found.min() >= 1
    assert found.max() < 2**24
    assert np.array_equal(found[::-1], masks.numbers(*key[:, ::-1]))
    pairs = len(found) - len(np.unique(found))
    assert pairs == pytest.approx(len(found) ** 2 / 2**25, rel=0.15)
    cell = np.arange(720 * 720)
    assert len(np.unique(masks.numbers(cell, 0 * cell).astype(np.float32))) == len(cell)


def test_masks_are_written_by_name_and_in_one_colour_each(tmp_path, monkeypatch):
    monkeypatch.setattr(exr_tags, "attributes", lambda *_: {})
    files = {end: tmp_path / f"masks.{end}" for end in ("exr", "png")}
    kinds = np.arange(len(masks.NAMES))[None].repeat(2, 0)
    pixels = np.stack([np.full(kinds.shape, 7.0), np.ones(kinds.shape), kinds], axis=-1)
    sensor.write_image(files["exr"], pixels)
    passes.finish("masks", files, {}, None, "drone", 1)
    kind, clear, instance, surface = np.moveaxis(sensor.read_image(files["exr"]), -1, 0)
    assert np.array_equal(kind, kinds)
    assert np.all(clear == 1.0)
    assert np.all(instance == 7.0)
    assert np.array_equal(surface, kinds)
    assert all(name in files["exr"].read_bytes()[:900] for name in (b"class\0", b"clear\0", b"instance\0"))
    shown = np.rint(sensor.read_image(files["png"])[..., :3] * 255)
    assert np.array_equal(shown[0], masks.COLOURS)


def seen(sidecar, latitude, longitude, height):
    """Pixel (u, v) of a WGS84 place by a sidecar alone, by PROJ's geocentric metres and not by our frame."""
    pyproj = pytest.importorskip("pyproj")
    ecef = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978")
    origin = sidecar["pose"]["origin"]
    lat, lon = np.radians([origin["latitude"], origin["longitude"]])
    zero = ecef.transform(origin["latitude"], origin["longitude"], origin["height"])
    turn = np.array(
        [
            [-np.sin(lon), np.cos(lon), 0.0],
            [-np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), np.cos(lat)],
            [np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)],
        ]
    )
    place = turn @ (np.array(ecef.transform(latitude, longitude, height)) - zero)
    matrix, lens = np.array(sidecar["pose"]["camera_to_world"]), sidecar["intrinsics"]
    x, y, z, _ = np.linalg.inv(matrix) @ np.append(place, 1.0)
    far = -z if lens["projection"] == "perspective" else 1.0
    return lens["cx"] + lens["fx"] * x / far, lens["cy"] - lens["fy"] * y / far


@pytest.mark.parametrize("name", ["drone", "two", "sat", "goes", "map"])
def test_a_sidecar_alone_says_where_a_place_is_seen(shot, name):
    cameras = [DRONE, Camera("two", Mounted("drone", 50.0)), Camera("sat", Satellite(swath=4000.0))]
    cameras += [Camera("goes", Satellite(swath=4000.0, geostationary=-137.0)), Camera("map", Minimap())]
    film = shot(*cameras).for_camera(name)
    (view,) = film.paths
    sidecar = json.loads(json.dumps(pose.describe(film, view, 3)))
    side = view.halves[2] / (view.meet or 1.0) * [0.5, 0.25]  # in the middle of the upper right quarter
    far = 800.0 if name in ("drone", "two") else np.linalg.norm(view.target[2] - view.position[2])
    across = side * (far if view.perspective or view.meet else 1.0)
    aim = view.position[2] + view.rotation[2] @ np.append(across, -far)
    place = (float(value[0]) for value in film.local_frame.reverse(aim[None]))
    assert seen(sidecar, *place) == pytest.approx((0.75 * 320, 0.375 * 180), abs=0.01)
    assert sidecar["pose"]["height_above_ground"] > 200.0
    assert sidecar["time_utc"].endswith("+00:00")
    assert set(sidecar["files"]) == {"rgb", "depth", "thermal"}
    assert sidecar["files"]["depth"] == {"exr": f"../../{name}/depth/{name}_depth_000003.exr"}


def test_heading_pitch_and_roll_are_those_of_the_camera(shot):
    key = CameraKey(0.0, 38.900, -120.599, 300.0, "point", 38.900, -120.589, 300.0)
    film = shot(Camera("drone", Drone(keys=(key,))))
    found = pose.pose(film, film.paths[0], 1)
    assert found["heading"] == pytest.approx(90.0, abs=0.05)
    assert found["roll"] == pytest.approx(0.0, abs=0.05)
    right, up, back = np.moveaxis(film.paths[0].rotation, -1, 0)
    tilted = replace(film.paths[0], rotation=np.stack([-up, right, back], axis=-1))
    assert pose.pose(film, tilted, 1)["roll"] == pytest.approx(90.0, abs=0.1)  # its right edge is down


def test_a_sidecar_is_made_again_when_passes_change_and_pictures_are_not():
    def made_with(name, *names):
        render = Render(passes=names)
        return fingerprint.collect_inputs(Settings(cameras=(DRONE,), render=render), {}, "drone", name)

    assert made_with("pose", "rgb", "pose") != made_with("pose", "rgb", "masks", "pose")
    assert made_with("rgb", "rgb", "pose") == made_with("rgb", "rgb", "masks", "pose")


def test_a_cut_off_sidecar_is_no_whole_file(tmp_path):
    path = tmp_path / "pose.json"
    path.write_text('{"pose": ')
    with pytest.raises(InputError, match="is not JSON"):
        verify.picture(path, (1, 1))
    path.write_text("{}")
    verify.picture(path, (1, 1))


def test_the_index_lists_frames_that_have_picture_and_sidecar(shot, tmp_path):
    film = shot(DRONE, Camera("sat", Satellite(swath=4000.0)))
    with Store(tmp_path, create=True) as store:
        for camera, frame, names in (
            ("drone", 1, "rgb pose masks"),
            ("drone", 2, "rgb"),
            ("sat", 1, "rgb pose"),
        ):
            view = film.for_camera(camera).paths[0]
            for name in names.split():
                for end in passes.known()[name].files:
                    path = tmp_path / passes.file_of(camera, name, frame, end)
                    path.parent.mkdir(parents=True, exist_ok=True)
                    text = (
                        json.dumps(pose.describe(film.for_camera(camera), view, frame))
                        if name == "pose"
                        else "x"
                    )
                    path.write_text(text)
                    store.add({}, {path.relative_to(tmp_path).as_posix(): describe(path)})
        dataset.write(store)
    assert not (tmp_path / "sat" / dataset.NAME).exists()
    index = json.loads((tmp_path / "drone" / dataset.NAME).read_text())
    (frame,) = index["frames"]
    assert frame["file_path"] == "rgb/drone_rgb_000001.png"
    assert frame["fl_x"] == pytest.approx(320 * 28.0 / 36.0)
    assert np.array(frame["transform_matrix"])[:3, 3] == pytest.approx(film.paths[0].position[0])
    assert set(frame["passes"]) == {"rgb", "pose", "masks"}
    assert (tmp_path / "drone" / frame["passes"]["masks"][0]).exists()
    (tmp_path / passes.file_of("drone", "pose", 1, "json")).unlink()
    with Store(tmp_path) as store:
        dataset.write(store)  # a removed pass does not fail


@pytest.fixture
def fused(shot, tmp_path):
    """The fused picture of a red picture, 300 K with a hot half, and ground at 500 m under a sky."""

    def make(resolution):
        film = shot(replace(DRONE, resolution=resolution))
        needed = {
            "rgb": {"png": tmp_path / "rgb.png"},
            "thermal": {"exr": tmp_path / "thermal.exr"},
            "depth": {"exr": tmp_path / "depth.exr"},
        }
        kelvin, depth = np.full((18, 32, 2), 300.0), np.full((18, 32, 2), 500.0)
        kelvin[:, 16:], depth[:9] = 800.0, 1e10
        sensor.write_image(needed["rgb"]["png"], np.full((18, 32, 3), (1.0, 0.0, 0.0)))
        sensor.write_image(needed["thermal"]["exr"], kelvin)
        sensor.write_image(needed["depth"]["exr"], depth)
        passes.finish("fused", {"png": tmp_path / "fused.png"}, needed, film, "drone", 3)
        return sensor.read_image(tmp_path / "fused.png")[..., :3]

    return make


@pytest.mark.parametrize(
    ("camera", "resolution"),
    [
        ((320, 180), (1280, 720)),
        ((400, 400), (720, 720)),
        ((1600, 900), (1600, 900)),
        ((426, 240), (1278, 720)),
    ],
)
def test_panels_lie_where_they_belong_in_any_size_and_small_cameras_get_a_legible_sheet(
    fused, camera, resolution
):
    picture = fused(camera)
    assert picture.shape == (*resolution[::-1], 3)
    red = np.all(np.abs(picture - [1.0, 0.0, 0.0]) < 0.02, axis=-1)
    rows, columns = (np.flatnonzero(red.any(axis=axis)) for axis in (1, 0))
    high, wide = np.ptp(rows) + 1, np.ptp(columns) + 1
    assert wide / high == pytest.approx(resolution[0] / resolution[1], rel=0.05)
    assert wide > 0.35 * resolution[0]
    gap = round(1.5 * min(resolution[0] / 178.0, resolution[1] / 100.0))
    left = columns[-1] + gap
    thermal = picture[rows[-1] - high // 2, left + 3 : left + wide - 2].mean(axis=-1)
    assert thermal[-5] > thermal[5] + 0.4, "the hot half is at the right"
    depth = picture[rows[-1] + gap + 4 : rows[-1] + gap + high - 4, left + wide // 2]
    assert np.ptp(depth[0]) < 0.02, "the sky is grey"
    assert np.ptp(depth[-1]) > 0.2


MOUNT = (
    replace(DRONE, passes=("rgb", "depth", "fused"), resolution=(640, 360)),
    Camera("far", Mounted("drone", 60.0), passes=("rgb",)),
    Camera("infrared", Mounted("drone", 14.0, 10.8), passes=("thermal",), resolution=(160, 128)),
    Camera("later", Mounted("drone"), passes=("thermal",)),
    Camera("map", Minimap("drone", 4000.0), passes=("rgb",), resolution=(200, 200)),
)


def test_a_place_is_at_the_same_point_of_every_panel_of_a_mount(shot, tmp_path):
    film = shot(*MOUNT)
    own, infrared, over = (film.for_camera(name).paths[0] for name in ("drone", "infrared", "map"))
    aim = own.position[2] + own.rotation[2] @ [0.2 * 800.0, 0.1 * 800.0, -800.0]
    pictures = {}
    for view, size in ((own, (640, 360)), (infrared, (160, 128)), (over, (200, 200))):
        x, y, z = view.rotation[2].T @ (aim - view.position[2])
        far = -z if view.perspective else 1.0
        share = 0.5 + 0.5 * np.array([x, -y]) / far / view.halves[2]
        grid = np.stack(np.meshgrid(*(np.arange(n) + 0.5 for n in size)), axis=-1)
        near = np.linalg.norm(grid - share * size, axis=-1) < 0.015 * size[0]
        pictures[view.camera.name] = near
    needed = {
        "rgb": {"png": tmp_path / "rgb.png"},
        "thermal": {"exr": tmp_path / "thermal.exr"},
        "depth": {"exr": tmp_path / "depth.exr"},
        "map": {"png": tmp_path / "map.png"},
    }
    green, red = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    sensor.write_image(needed["rgb"]["png"], np.where(pictures["drone"][..., None], green, 0.2 * red))
    sensor.write_image(needed["map"]["png"], np.where(pictures["map"][..., None], green, 0.2 * red))
    hot = np.where(pictures["infrared"], 1200.0, 300.0)
    sensor.write_image(needed["thermal"]["exr"], np.stack([hot, hot], axis=-1))
    sensor.write_image(needed["depth"]["exr"], np.full((360, 640, 2), 800.0))
    passes.finish("fused", {"png": tmp_path / "f.png"}, needed, film.for_camera("drone"), "drone", 3)
    shown = sensor.read_image(tmp_path / "f.png")[..., :3]
    sheet = _sheet.Sheet(1280, 720)
    wide, high = sheet.wide * sheet.unit, sheet.high * sheet.unit
    gap, top = 1.5 * sheet.unit, sheet.top * sheet.unit

    def spot(place, like):
        row, column = divmod(place, 2)
        x, y = gap + column * (wide + gap), top + row * (high + gap)
        panel = shown[round(y) : round(y + high), round(x) : round(x + wide)]
        rows, columns = np.nonzero(like(panel) & (np.arange(panel.shape[1]) > 0.4 * wide))  # the name is left
        return (columns.mean() + 0.5) / wide, (rows.mean() + 0.5) / high

    def is_green(panel):
        return (panel[..., 1] > 0.7) & (panel[..., 0] < 0.4) & (panel[..., 2] < 0.4)

    expected = (0.5 + 0.5 * 0.2 / own.halves[2, 0], 0.5 - 0.5 * 0.1 / own.halves[2, 1])
    one = 1.5 / wide
    assert spot(0, is_green) == pytest.approx(expected, abs=one)
    assert spot(1, lambda panel: panel.min(axis=-1) > 0.9) == pytest.approx(expected, abs=one)
    away = (aim - own.position[2])[:2] / 4000.0
    assert spot(2, is_green) == pytest.approx((0.5 + away[0], 0.5 - away[1] * wide / high), abs=one)


@pytest.mark.parametrize("minimap", [False, True])
def test_the_map_shows_front_and_scar_whatever_its_ground(make_run, tmp_path, minimap):
    """West of a line has burned long ago, a strip lately, and a minimap sees nothing but white smoke."""
    rows, columns = 8, 10
    arrival = np.where(np.arange(columns) < 3, -7200.0, np.where(np.arange(columns) < 5, -60.0, np.nan))
    fields = {"fuel_arrival_time": np.tile(arrival, (rows, 1)).astype(np.float32)}
    cameras = (DRONE, Camera("map", Minimap("drone", 3000.0), passes=("rgb",)))[: 2 if minimap else 1]
    ground, render = TerrainSettings(near_radius=0.0, apron=5000.0), Render(resolution=(640, 360))
    settings = Settings(time=Time(frames=5), terrain=ground, cameras=cameras, render=render)
    made = Shot(settings, runs.open(make_run(**fields)))
    view = made.for_camera("drone").paths[0]
    axes = _sheet.Sheet(640, 360).panel(2, "MAP")
    white = np.ones((50, 90, 3))
    _map.draw(axes, made, view, 3, *((white, 3000.0) if minimap else ()))
    canvas = axes.figure.canvas
    canvas.draw()
    shown = np.asarray(canvas.buffer_rgba())[..., :3] / 255.0

    def at(column):  # of the fuel grid, next to the camera and its path
        place = made.local_frame.forward(
            made.run.fuel_latitude[1:2],
            np.interp([column], range(columns), made.run.fuel_longitude),
            [0.0],
        )
        x, y = axes.transData.transform(place[0, :2] - view.position[2, :2])
        return shown[round(shown.shape[0] - y), round(x)]

    scar, late, green = at(1.0), at(3.6), at(7.0)
    assert scar.max() < 0.6
    assert scar[0] > scar[2], "dark and red"
    assert late[0] > 0.75, "orange"
    assert late[0] - late[2] > 0.4
    assert green[1] - scar[1] > 0.15
    line = [at(column) for column in np.linspace(3.9, 5.1, 60)]
    assert any(each[1] > 0.6 and each[2] < 0.45 for each in line), f"no yellow line: {line}"


def test_a_fused_view_asks_its_mount_for_what_its_camera_does_not_record(shot):
    film = shot(*MOUNT)
    assert mount.taken(film.settings, film.cameras, "drone", passes.known()["fused"]) == {
        "rgb": ("drone", "rgb"),
        "thermal": ("infrared", "thermal"),
        "depth": ("drone", "depth"),
        "map": ("map", "rgb"),
    }
    asked = plan.pictures(film, "2", "drone", "fused")
    assert asked == [
        Picture("infrared", 2, "thermal"),
        Picture("map", 2, "rgb"),
        Picture("drone", 2, "fused"),
    ]
    assert plan.rounds(film, asked) == [asked[:2], asked[2:]]
    assert plan.pictures(film, "2", "drone", "rgb") == [Picture("drone", 2, "rgb")]


def test_a_fused_view_is_made_again_when_a_sensor_of_its_mount_changes():
    def made_with(*cameras):
        return fingerprint.collect_inputs(Settings(cameras=cameras), {}, "drone", "fused")

    other = replace(MOUNT[2], rig=replace(MOUNT[2].rig, focal_length=10.0))
    unused = replace(MOUNT[3], rig=replace(MOUNT[3].rig, focal_length=10.0))
    assert made_with(*MOUNT) != made_with(*MOUNT[:2], other, *MOUNT[3:])
    assert made_with(*MOUNT) == made_with(*MOUNT[:3], unused, *MOUNT[4:])


def test_masks_in_eevee_are_refused_in_the_file_and_on_the_command_line(shot, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text('[render]\nengine = "eevee"\npasses = ["masks"]\n' + SCENE.split("[[cameras]]\nkind")[0])
    with pytest.raises(InputError, match=r"scene\.toml:3:1: .*cannot record masks with EEVEE"):
        scene_file.read(scene)
    made = shot(DRONE)
    made.settings = replace(made.settings, render=replace(made.settings.render, engine="eevee"))
    assert plan.pictures(made, "1", names="rgb")
    with pytest.raises(UsageError, match=r"--passes: .*cannot record masks with EEVEE"):
        plan.pictures(made, "1", names="masks")


def test_what_is_told_beside_the_panels_is_true(shot, monkeypatch):
    film_shot = shot(DRONE)
    square_metres = 4046.8564224
    burned = lambda _, moments: [square_metres * (1000.0 + time) for time in moments]  # noqa: E731
    monkeypatch.setattr(info, "burned", burned)
    facts = dict(fused_pass.facts(film_shot, "drone", 3))
    assert facts["TIME"][1] == f"{film_shot.utc(3):%Y-%m-%d %H:%M:%S} UTC"
    assert facts["TIME"][0].endswith("PDT")
    latitude, longitude, height = (
        float(v[0]) for v in film_shot.local_frame.reverse(film_shot.paths[0].position[2:3])
    )
    assert facts["POSITION"] == [f"{latitude:.5f}° N", f"{-longitude:.5f}° W"]
    assert facts["HEIGHT"][1].startswith(f"{height:,.0f} m ")
    assert facts["VIEW"] == ["65° wide"]
    assert facts["FILM"] == [f"{film_shot.frames.step * film_shot.settings.time.fps:,.3g}× as fast"]
    assert facts["BURNED"] == [f"{1000.0 + film_shot.frames.time(3):,.0f} acres"]
    film_shot.settings = replace(
        film_shot.settings, time=replace(film_shot.settings.time, fps=round(11_160 / film_shot.frames.step))
    )
    (film,) = dict(fused_pass.facts(film_shot, "drone", 3))["FILM"]
    assert float(film.split("×")[0].replace(",", "")) == pytest.approx(11_160, rel=0.01)
    assert film[2] == ","


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080), (960, 720), (2560, 720)])
@pytest.mark.parametrize("pace", ["2×", "1,800×", "1,230,000×"])
def test_what_is_told_beside_the_panels_lies_in_the_picture(size, pace):
    """The pace of a long run, a long title and a long place are drawn smaller and not over the edge."""
    sheet = _sheet.Sheet(*size)
    facts = [
        ("TIME", ["17 Sep 2014 15:42 PDT", "2014-09-17 22:42:00 UTC"]),
        ("POSITION", ["38.97700° N", "120.57200° W"]),
        ("HEIGHT", ["12,345 m AGL", "15,432 m WGS84"]),
        ("FILM", [f"{pace} as fast"]),
    ]
    sheet.head("King Fire, a what-if run with a name that is much too long for any picture  ·  drone", facts)
    renderer = sheet.canvas.get_renderer()
    boxes = [text.get_window_extent(renderer) for text in sheet.figure.texts]
    assert max(box.x1 for box in boxes) <= size[0]
    assert min(box.x0 for box in boxes) >= 0
    title, clock = boxes[2], boxes[:2]
    assert title.x1 < min(box.x0 for box in clock)
    pace_size = sheet.figure.texts[-1].get_size()
    assert (pace_size == pytest.approx(sheet.points(2.3))) == (pace == "2×")
