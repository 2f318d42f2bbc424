"""The user's own orthophoto: each place of the ground gets the colour that the file has there."""

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import orthophoto
from firetwin_core import sensor
from scene_text import GROUND_ALONE

BOX = (-120.597, 38.901, -120.587, 38.908)  # west, south, east, north; the run reaches 600 m beyond


def colours(latitude, longitude):
    """Red rises to the east and green to the north, blue is waves."""
    red = (longitude - BOX[0]) / (BOX[2] - BOX[0])
    green = (latitude - BOX[1]) / (BOX[3] - BOX[1])
    blue = 0.5 + 0.4 * np.sin(latitude * 9000.0)
    return np.stack([red, green, blue])


@pytest.fixture
def make(make_run, tmp_path):
    """Write a scene of the small run with a photo, and give its choice."""
    make_run()

    def scene(key, near=0.0, apron=3000.0):
        (tmp_path / "scene.toml").write_text(GROUND_ALONE.format(key=key, near=near, apron=apron))
        return ShotSource(scene=str(tmp_path / "scene.toml"))

    return scene


def image(path, count=(300, 240)):
    """Write a picture of the box; the world file that belongs to it."""
    width, height = count
    dx, dy = (BOX[2] - BOX[0]) / width, (BOX[3] - BOX[1]) / height
    longitude, latitude = np.meshgrid(
        BOX[0] + (np.arange(width) + 0.5) * dx, BOX[3] - (np.arange(height) + 0.5) * dy
    )
    sensor.write_image(path, np.moveaxis(colours(latitude, longitude), 0, -1))
    return f"{dx:.12f}\n0\n0\n{-dy:.12f}\n{BOX[0] + 0.5 * dx:.12f}\n{BOX[3] - 0.5 * dy:.12f}\n"


def off(shot, picture):
    """Difference from the true colours at pixels that count fully; share of the picture that counts."""
    height, width = picture.pixels.shape[:2]
    east, north = (
        picture.low[k] + (np.arange(count) + 0.5) / count * (picture.high[k] - picture.low[k])
        for k, count in enumerate((width, height))
    )
    place = shot.ground.geodetic(*(v.ravel() for v in np.meshgrid(east, north)))
    wanted = np.moveaxis(colours(*(v.reshape(height, width) for v in place)), 0, -1)
    full = picture.pixels[..., 3] == 255
    return picture.pixels[..., :3][full] / 255.0 - wanted[full], full.mean()


WAYS = ("world file", "extent", "EPSG:32610", "EPSG:3310", "EPSG:4326")


def place(tmp_path, way):
    """Write the photo in one of the ways, and give the keys."""
    if way in ("world file", "extent"):
        world = image(tmp_path / "photo.png")
        if way == "world file":
            (tmp_path / "photo.pgw").write_text(world)
            return 'photo = "photo.png"'
        return f'photo = "photo.png"\nphoto_extent = {list(BOX)}'
    rasters = pytest.importorskip("rasters", reason="needs rasterio")
    step = 4.0e-5 if way == "EPSG:4326" else 4.0
    rasters.write_tiff(
        tmp_path / "photo.tif", lambda *at: 255.0 * np.clip(colours(*at), 0, 1),
        projection=way, step=step, box=BOX, dtype="uint8",
    )  # fmt: skip
    return 'photo = "photo.tif"'


@pytest.mark.parametrize("way", WAYS)
def test_each_place_has_the_colour_that_the_photo_has_there(make, tmp_path, way):
    shot = make(place(tmp_path, way)).shot()
    (picture,) = orthophoto.pictures(shot)
    found, full = off(shot, picture)
    inside = np.abs(found).max(axis=1)
    assert full > 0.85
    assert np.percentile(inside, 99) < 0.03
    assert np.abs(found.mean(axis=0)).max() < 0.004
    size = picture.high - picture.low
    assert size[0] == pytest.approx(0.01 * 86_800.0, rel=0.06)
    assert size[1] == pytest.approx(0.007 * 111_000.0, rel=0.06)


def test_what_is_near_cameras_is_shown_more_finely(make, tmp_path):
    shot = make(place(tmp_path, "extent") + "\nphoto_size = 64", near=150.0).shot()
    whole, near = orthophoto.pictures(shot)
    assert max(whole.pixels.shape) == 64
    assert np.all(near.low >= whole.low - 1e-6)
    assert np.all(near.high <= whole.high + 1e-6)
    eye = shot.ground.eyes[0, :2]
    assert np.all((near.low < eye) & (eye < near.high))
    scale = [float(np.max((p.high - p.low) / p.pixels.shape[1::-1])) for p in (whole, near)]
    assert scale[1] < 0.7 * scale[0]
    for picture in (whole, near):
        assert np.percentile(np.abs(off(shot, picture)[0]), 99) < 0.08


def test_alpha_and_no_data_leave_the_ground_as_it_is(make, tmp_path):
    rasters = pytest.importorskip("rasters", reason="needs rasterio")

    def halves(latitude, longitude):
        alpha = np.where(longitude > -120.592, 255, 0)[None]
        return np.concatenate([200.0 + 0.0 * colours(latitude, longitude), alpha])

    rasters.write_tiff(tmp_path / "photo.tif", halves, box=BOX, dtype="uint8", step=4.0)
    (picture,) = orthophoto.pictures(make('photo = "photo.tif"').shot())
    alpha = picture.pixels[picture.pixels.shape[0] // 2, :, 3]
    assert alpha[: len(alpha) // 2 - 3].max() == 0
    assert alpha[len(alpha) // 2 + 10 : -10].min() == 255


def test_a_photo_without_rasterio_is_a_png(make, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rasterio", None)
    assert len(orthophoto.pictures(make(place(tmp_path, "world file")).shot())) == 1
    (tmp_path / "photo.tif").write_bytes(b"II*\0" + bytes(40))
    with pytest.raises(InputError, match=r"scene\.toml:9:1: terrain\.photo needs .* 'firetwin\[raster\]'"):
        make('photo = "photo.tif"').shot()


BAD = {
    "none": ('photo = "no.png"', None, r"scene\.toml:9:1: terrain\.photo: no such file .*no\.png"),
    "no world": ('photo = "photo.png"', None, r"photo\.png: has no world file"),
    "four": ('photo_extent = [1.0, 2.0]', None, r"9:1: terrain\.photo_extent must be west, south"),
    "turned": ('photo_extent = [2.0, 1.0, 1.0, 2.0]', None, r"terrain\.photo_extent must be west, south"),
    "alone": (f'photo_extent = {list(BOX)}', None, r"scene\.toml:9:1: .*_extent needs a terrain\.photo"),
    "elsewhere": (
        'photo = "photo.png"\nphoto_extent = [10.0, 50.0, 11.0, 51.0]', None,
        r"photo\.png: covers 50\.000 to 51\.000 N .* outside of the run, which covers",
    ),
    "metres": ('photo = "photo.png"', "10\n0\n0\n-10\n700000\n4300000\n", r"not in degrees.*gdal"),
    "words": ('photo = "photo.png"', "ten\n", r"photo\.pgw: not a world file: it must hold six"),
    "no area": ('photo = "photo.png"', "0\n0\n0\n0\n1\n1\n", r"photo\.pgw: not a world file: its pixels"),
}  # fmt: skip


@pytest.mark.parametrize(("key", "world", "reason"), BAD.values(), ids=BAD)
def test_a_bad_photo_is_one_line(make, tmp_path, key, world, reason):
    image(tmp_path / "photo.png", (12, 10))
    if world:
        (tmp_path / "photo.pgw").write_text(world)
    with pytest.raises(InputError, match=reason) as caught:
        make(key).shot()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("data", [b"", b"hello", b"\x89PNG\r\n\x1a\n", b"II*\0" + bytes(20)])
def test_no_picture_is_one_line(make, tmp_path, data):
    if data.startswith(b"II"):
        pytest.importorskip("rasterio")
    (tmp_path / "photo.png").write_bytes(data)
    with pytest.raises(InputError, match=r"[^:]*photo\.png: "):
        make(f'photo = "photo.png"\nphoto_extent = {list(BOX)}').shot()


def test_colours_of_sixteen_bits_are_refused(make, tmp_path):
    rasters = pytest.importorskip("rasters", reason="needs rasterio")
    rasters.write_tiff(tmp_path / "photo.tif", lambda *at: 9000.0 * colours(*at), box=BOX, dtype="uint16")
    with pytest.raises(InputError, match=r"photo\.tif: has uint16 values.*gdal_translate -ot Byte -scale"):
        make('photo = "photo.tif"').shot()


def test_the_world_file_is_part_of_the_photo(make, tmp_path):
    choice = make(place(tmp_path, "world file"))
    before = orthophoto.inputs(choice.shot().settings)
    assert len(before) == 3
    world = (tmp_path / "photo.pgw").read_text()
    (tmp_path / "photo.pgw").write_text(world.replace("-120.59", "-120.58"))
    assert orthophoto.inputs(choice.shot().settings) != before
