"""The pass `data`: motion, positions and mattes against closed forms, `masks` and a reader of Cryptomatte."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.passes import data, masks
from firetwin.shot import exr_tags
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.path import Path
from firetwin_core import sensor

HEIGHT, WIDTH = 18, 32
AWAY = 70.0  # m, distance of smoke


def view(perspective=True, zoom=None):
    """A camera 100 m above the ground that looks down and moves 10 m to the right in each of 3 frames."""
    place = np.array([[0.0, 0.0, 100.0], [10.0, 0.0, 100.0], [20.0, 0.0, 100.0]])
    turn = np.tile(np.eye(3), (3, 1, 1))
    half = (0.8, 0.45) if perspective else (80.0, 45.0)
    camera = SimpleNamespace(name="drone")
    return Path(camera, place, turn, np.zeros((3, 3)), half, perspective=perspective, wider=zoom)


@pytest.mark.parametrize("perspective", [True, False])
def test_pixels_move_against_a_moving_camera(perspective):
    path, planar = view(perspective), np.full((HEIGHT, WIDTH), 100.0, np.float32)
    for other, sign in ((3, -1.0), (1, 1.0)):
        found = data.move(path, 2, planar, other)
        assert found[..., 0] == pytest.approx(sign * 10.0 / 160.0 * WIDTH, abs=1e-4)
        assert found[..., 1] == pytest.approx(0.0, abs=1e-4)
    assert not data.move(path, 3, planar, 4).any()
    assert not data.move(path, 1, planar, 0).any()


def test_a_zoom_moves_pixels_outwards_and_v_is_up():
    path = view(zoom=np.array([1.0, 0.5, 0.5]))
    sky = np.full((HEIGHT, WIDTH), 1.0e10, np.float32)
    found = data.move(path, 1, sky, 2)
    assert found[0, -1] == pytest.approx([15.5, 8.5], abs=1e-3)
    assert found[-1, 0] == pytest.approx([-15.5, -8.5], abs=1e-3)


def test_motion_leads_to_the_same_place_in_the_next_frame():
    path = view()
    planar = np.full((HEIGHT, WIDTH), 100.0, np.float32)
    there = data.move(path, 1, planar, 2)
    place = pixel_rays.points(path, 1, planar)
    low = pixel_rays.points(path, 2, planar)
    shift = int(there[0, 0, 0])
    assert low[:, :shift] == pytest.approx(place[:, -shift:])


def test_classes_share_a_pixel():
    surface = np.full((3, 4), masks.GROUND, np.float32)
    surface[:, 2:] = masks.TREE
    clear = np.full((3, 4), 0.75, np.float32)
    found = data.cover_classes(surface, clear)
    assert found.sum(axis=-1) == pytest.approx(1.0)
    assert found[..., masks.SMOKE] == pytest.approx(0.25)
    assert found[1, :, masks.TREE] == pytest.approx(0.75 * np.array([0.0, 0.25, 0.75, 1.0]))


def test_opaque_smoke_is_smoke_alone():
    found = data.cover_classes(np.full((2, 2), masks.SMOKE, np.float32), np.zeros((2, 2), np.float32))
    assert found[..., masks.SMOKE] == pytest.approx(1.0)


def test_trees_add_up_to_the_class_of_trees():
    random = np.random.default_rng(1)
    surface = random.choice([masks.GROUND, masks.TREE], (70, 9)).astype(np.float32)
    instance = np.where(surface == masks.TREE, random.integers(1, 40, surface.shape), 0).astype(np.float32)
    clear = random.uniform(0.2, 1.0, surface.shape).astype(np.float32)
    found, numbers = data.mark_trees(surface, instance, clear)
    share = data.cover_classes(surface, clear)[..., masks.TREE]
    full = found[..., -1] == 0.0  # pixels with no more trees than ranks
    assert full.any()
    assert found[full][:, 1::2].sum(axis=-1) == pytest.approx(share[full], abs=1e-6)
    assert len(numbers) == len(np.unique(instance)) - 1


def test_a_building_is_no_tree():
    surface = np.full((2, 2), masks.BUILDING, np.float32)
    found, numbers = data.mark_trees(surface, np.ones((2, 2), np.float32), np.ones((2, 2), np.float32))
    assert not found.any()
    assert numbers == {}


@pytest.fixture
def made(tmp_path, monkeypatch):
    """The EXR and the JSON of a picture of all classes, and the arrays that they are made from."""
    monkeypatch.setattr(exr_tags, "attributes", lambda *_, **__: {"colorInteropID": "data"})
    surface = np.repeat(np.arange(7, dtype=np.float32), WIDTH * HEIGHT // 7 + 1)[: WIDTH * HEIGHT]
    surface = np.sort(surface.reshape(HEIGHT, WIDTH), axis=1)
    clear = np.ones_like(surface)
    clear[:4] = 0.25
    instance = np.where(surface == masks.TREE, 3.0 + np.arange(HEIGHT)[:, None] // 9, 0.0).astype(np.float32)
    kind = np.where(clear > 0.5, surface, masks.SMOKE)
    planar = np.where(surface == masks.SKY, np.float32(1.0e10), np.float32(100.0))
    normal = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normal[:] = 0.1, 0.2, 0.9
    warm = np.linspace(280.0, 900.0, WIDTH * HEIGHT, dtype=np.float32).reshape(HEIGHT, WIDTH)
    needed = {name: {"exr": tmp_path / f"{name}.exr"} for name in ("depth", "normal", "masks", "thermal")}
    sensor.write_image(needed["depth"]["exr"], np.stack([planar, planar], -1), names=["planar", "range"])
    sensor.write_image(needed["normal"]["exr"], normal)
    away = np.where(clear < 1.0, np.float32(AWAY), np.float32(1.0e10))
    mattes = np.stack([kind, clear, instance, away, surface], -1)
    names = ["class", "clear", "instance", "smoke_range", "surface"]
    sensor.write_image(needed["masks"]["exr"], mattes, names=names)
    sensor.write_image(
        needed["thermal"]["exr"], np.stack([warm, warm / 10], -1), names=["kelvin", "radiance"]
    )
    files = {end: tmp_path / f"drone_data_000002.{end}" for end in ("exr", "json")}
    data.finish(files, needed, SimpleNamespace(paths=[view()]), "drone", 2)
    return files, {"surface": surface, "clear": clear, "kind": kind, "warm": warm, "instance": instance}


def test_the_file_has_its_layers(made):
    files, given = made
    channels = sensor.read_channels(files["exr"])
    assert set(channels) == {*data._NAMES, "smoke.Z"}
    assert (channels["smoke.Z"][4:] == 1.0e10).all()
    ranges = pixel_rays.ranges(view(), 2, channels["smoke.Z"])
    assert ranges[:4] == pytest.approx(AWAY)
    assert channels["Z"][0, 0] == np.float32(1.0e10)
    assert np.array_equal(channels["thermal.kelvin"], given["warm"])
    assert [channels[f"N.{axis}"][5, 5] for axis in "XYZ"] == pytest.approx([0.1, 0.2, 0.9])
    solid = given["surface"] != masks.SKY
    assert channels["P.Z"][solid] == pytest.approx(0.0, abs=1e-4)
    assert channels["P.X"][HEIGHT // 2, -1] == pytest.approx(10.0 + 80.0 * 31 / 32)
    assert not channels["P.X"][~solid].any()
    assert channels["forward.u"][solid] == pytest.approx(-2.0, abs=1e-4)


def test_openexr_reads_types_and_names(made):
    openexr = pytest.importorskip("OpenEXR")
    files, _ = made
    with openexr.File(str(files["exr"]), separate_channels=True) as file:
        header, channels = file.header(), file.channels()
        assert header["compression"] == openexr.ZIPS_COMPRESSION
        assert {each.pixels.dtype for each in channels.values()} == {np.dtype(np.float32)}
        named = {name: text for name, text in header.items() if name.startswith("cryptomatte/")}
    assert sorted(text for name, text in named.items() if name.endswith("/name")) == [
        "CryptoClass",
        "CryptoTree",
    ]
    beside = [text for name, text in named.items() if name.endswith("/manif_file")]
    assert beside == [files["json"].name]
    assert sorted(json.loads(files["json"].read_text())) == ["tree_00000003", "tree_00000004"]


def test_another_reader_finds_the_mattes(made):
    reader = pytest.importorskip("cryptomatte_api")
    files, given = made
    layers = {
        each.metadata().name(): each for each in reader.Cryptomatte.load(files["exr"], load_preview=False)
    }
    mattes = layers["CryptoClass"].masks()
    assert sum(mattes.values()) == pytest.approx(1.0, abs=1e-5)
    inner = (slice(6, -2), slice(None))
    for name in ("fire", "tree", "smoke"):
        here = given["kind"] == masks.NAMES.index(name)
        assert np.array_equal(mattes[name][inner] > 0.5, here[inner])
    assert mattes["smoke"][1] == pytest.approx(
        np.where(given["surface"][1] == masks.SMOKE, 1.0, 0.75), abs=0.3
    )
    trees = layers["CryptoTree"].masks()
    assert np.array_equal(trees["tree_00000003"][:8] > 0.1, mattes["tree"][:8] > 0.1)
