"""Tiles put together: each place has the colour of its tile, and coarser tiles stand in for missing ones."""

import numpy as np
import pytest
from colour_tiles import FRESH, Tiles, colour, png
from firetwin.errors import InputError
from firetwin.shot.surface.drape import Drape, DrapeArea
from firetwin.shot.surface.drape_photo import DrapePhoto
from firetwin.tiles.imagery import mercator, mosaic
from firetwin.tiles.imagery.address import TileAddress
from firetwin.tiles.imagery.mosaic import Patch, TileServer
from firetwin.tiles.sources import MissingError
from firetwin.tiles.sources._source import missing
from firetwin_core import sensor
from lying_server import Reply

SIDE = 128  # pixels: the smallest tiles are decoded fastest
HOST = "https://a.example"


class Direct:
    """Answers of a server, without a connection to it."""

    parallel = 4

    def __init__(self, root, answers):
        self.root, self.answers, self.asked = root, answers, []

    def resolve(self, root, url):
        return url

    def name(self, url):
        return url

    def read(self, url, most):
        path = url.removeprefix(HOST)
        self.asked.append(path)
        reply = self.answers.get(path)
        if reply.status != 200:
            raise missing(url, f"is not there (status {reply.status})")
        return reply.body


def make(answers, row="{y}"):
    """A tile server with these answers."""
    url = f"{HOST}/t/{{z}}/{{x}}/{row}.png"
    return TileServer(Direct(url, answers), TileAddress(url))


def shown(tmp_path, pixels, patch):
    """The colours of a mosaic as the ground takes them."""
    sensor.write_image(tmp_path / "a.png", pixels / 255.0)
    side = pixels.shape[0] // patch.size[1]
    area = DrapeArea(
        (0, 0), (1, 1), 1.0, patch.level, patch.columns[0], patch.rows[0], side, "a.png"
    )  # fmt: skip
    return DrapePhoto(Drape(tmp_path, (area,), (), ()))


PLACES = {
    "a fire": (38.9012, -120.6123),
    "the date line": (-16.51, 180.0),
    "just past the date line": (-16.51, -180.0),
    "the north": (84.93, 15.6),
    "the south": (-84.2, -70.01),
}


@pytest.mark.parametrize(("level", "rows"), [(2, "{y}"), (7, "{-y}"), (13, "{y}"), (18, "{-y}")])
@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_a_place_has_the_colour_of_its_tile(tmp_path, level, place, rows):
    mercantile = pytest.importorskip("mercantile", reason="needs mercantile")
    if abs(place[1]) == 180.0:  # a third of a tile next to it
        place = place[0], place[1] * (1.0 - 2.0 / 3.0 / 2**level)
    wanted = mercantile.tile(place[1], place[0], level)
    past = place[1] < 0.0 and wanted.x == 0  # a run across the line goes on in the east
    column = wanted.x + (1 << level if past else 0)
    last = min(wanted.y + 2, 1 << level)
    patch = Patch(level, (column - 1, column + 2), (max(wanted.y - 1, 0), last))
    tiles = make(Tiles(side=SIDE, south=rows == "{-y}"), rows)
    photo = shown(tmp_path, tiles.mosaic(patch), patch)
    assert tiles.missing == {}
    for longitude in (place[1], place[1] + 360.0):
        found = photo.colours(np.full((1, 1), place[0]), np.full((1, 1), longitude), 1.0e-3)
        assert tuple(np.rint(255.0 * found[0, 0]).astype(int)) == (*colour(level, wanted.x, wanted.y), 255)


def test_the_edge_between_two_tiles_is_where_their_bounds_are(tmp_path):
    level, x, y = 12, 675, 1565
    patch = Patch(level, (x, x + 2), (y, y + 2))
    photo = shown(tmp_path, make(Tiles()).mosaic(patch), patch)
    latitude, longitude = mercator.place_of(x + 1.0, y + 0.5, level)
    texel = 360.0 / (256 * 2**level)
    east = longitude + texel * np.array([[-0.6, 0.0, 0.6]])
    found = 255.0 * photo.colours(np.full((1, 3), latitude), east, 1.0)[0, :, :3]
    left, right = (np.array(colour(level, column, y)) for column in (x, x + 1))
    assert np.allclose(found, [left, 0.5 * (left + right), right], atol=1.0)


def test_the_parent_stands_in_for_a_missing_tile_and_is_named():
    level, x, y = 9, 85, 195
    answers = Tiles(gone={(level, x, y), (level - 1, x >> 1, y >> 1), (level, x + 1, y)})
    tiles = make(answers)
    pixels = tiles.mosaic(Patch(level, (x - 1, x + 2), (y, y + 1)))
    assert tuple(pixels[0, 256 + 128, :3]) == colour(level - 2, x >> 2, y >> 2)
    assert tuple(pixels[0, 128, :3]) == colour(level, x - 1, y)
    assert tuple(pixels[0, 512 + 9, :3]) == colour(level - 1, (x + 1) >> 1, y >> 1)
    names = sorted(name for name, _ in tiles.missing.values())
    assert names == [
        f"{HOST}/t/{key}.png"
        for key in (f"{level - 1}/{x >> 1}/{y >> 1}", f"{level}/{x}/{y}", f"{level}/{x + 1}/{y}")
    ]
    assert len(tiles.source.asked) == len(set(tiles.source.asked))


def test_a_part_of_a_coarser_tile_is_the_part_at_that_place():
    level, x, y = 6, 21, 44
    coarse = np.zeros((256, 256, 3), np.uint8)
    coarse[..., 0], coarse[..., 1] = np.arange(256), np.arange(256)[:, None]
    answers = Tiles(gone={(level, x, y)})
    answers[f"/t/{level - 1}/{x >> 1}/{y >> 1}.png"] = Reply(200, png(coarse), FRESH)
    pixels = make(answers).mosaic(Patch(level, (x, x + 1), (y, y + 1)))
    assert (pixels[0, 0, 0], pixels[0, -1, 0]) == (128, 255)  # x is odd: the eastern half
    assert (pixels[0, 0, 1], pixels[-1, 0, 1]) == (0, 127)  # y is even: the northern half


def test_columns_at_the_date_line_are_asked_for_once():
    tiles = make(Tiles(side=SIDE))
    tiles.mosaic(Patch(3, (6, 10), (3, 4)))
    assert [path for path in tiles.source.asked if "/8/" in path] == []
    assert sorted(tiles.source.asked) == [f"/t/3/{x}/3.png" for x in (0, 1, 6, 7)]


def test_a_server_without_any_tile_is_an_error_with_its_reason():
    tiles = make(Tiles(highest=-1))
    with pytest.raises(InputError, match=r"status 404.*the server has no tile of the scene"):
        tiles.mosaic(Patch(10, (300, 305), (300, 305)))
    assert len(tiles.source.asked) == len(set(tiles.source.asked))


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (b"<html>not here</html>", "is not a PNG or JPEG"),
        (b"\x89PNG\r\n\x1a\n", "cannot"),
        (png(np.zeros((256, 200, 3))), "200 x 256 pixels"),
        (png(np.zeros((300, 300, 3))), "300 x 300 pixels"),
        (png(np.zeros((256, 256, 3)))[:-60], ""),
    ],
)
def test_what_is_no_tile_is_missing(body, why):
    with pytest.raises(MissingError) as error:
        mosaic.decode(body, "a tile")
    assert why in error.value.reason


def test_transparent_and_grey_tiles():
    half = np.full((256, 256, 4), 200, np.uint8)
    half[:, :128, 3] = 0
    assert mosaic.decode(png(half), "a tile")[0, :, 3].tolist() == [0] * 128 + [200] * 128
    grey = mosaic.decode(png(np.full((256, 256), 77)), "a tile")
    assert grey[5, 5].tolist() == [77, 77, 77, 255]


def test_tiles_of_another_size_than_the_first_are_missing():
    answers = Tiles(side=512)
    answers["/t/4/5/6.png"] = Reply(200, png(np.zeros((256, 256, 3))), FRESH)
    tiles = make(answers)
    pixels = tiles.mosaic(Patch(4, (4, 6), (6, 7)))
    assert tiles.side == 512
    assert pixels.shape == (512, 1024, 4)
    assert [reason for _, reason in tiles.missing.values()] == ["is 256 pixels large, others 512"]
