"""Orthophoto from a tile server: its level, positions of tiles, credits, and rejected settings."""

import logging

import numpy as np
import pytest
from colour_tiles import FRESH, Tiles, colour, png
from firetwin.errors import InputError
from firetwin.imaging.credits import Credits
from firetwin.jobs.tiles import imagery
from firetwin.jobs.tiles import make as make_job
from firetwin.shot import picture_credits
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import drape, drape_plan, orthophoto
from firetwin.tiles.imagery import mercator
from firetwin.tiles.sources.network import Network
from lying_server import Reply, serving
from scene_text import GROUND_ALONE
from wmts_text import document, layer, matrices

CREDIT = 'photo_credit = "Somebody; Somebody else"\n'


@pytest.fixture
def server():
    with serving() as each:
        each.answers = Tiles()
        yield each


@pytest.fixture
def make(make_run, tmp_path, server):
    """make(keys, path): a scene of the small run with the server's tiles."""
    make_run()

    def scene(keys="photo_size = 512", path="/t/{z}/{x}/{y}.png", near=0.0, host="", credit=CREDIT):
        text = f'photo_url = "{host or server.url}{path}"\n{credit}{keys}'
        (tmp_path / "scene.toml").write_text(GROUND_ALONE.format(key=text, near=near, apron=3000.0))
        return ShotSource(scene=str(tmp_path / "scene.toml"))

    return scene


def fetched(choice, tmp_path, **network):
    shot = choice.shot()
    return shot, imagery.make(shot, network=Network(**({"cache": tmp_path / "http"} | network)))


def test_each_place_of_the_ground_has_the_colour_of_its_tile(make, tmp_path):
    mercantile = pytest.importorskip("mercantile", reason="needs mercantile")
    shot, _ = fetched(make(), tmp_path)
    (area,) = drape.of_shot(shot).areas
    (picture,) = orthophoto.pictures(shot)
    height, width = picture.pixels.shape[:2]
    step = (picture.high - picture.low) / (width, height)
    wrong = checked = 0
    for row, column in np.random.default_rng(1).integers(20, (height - 20, width - 20), (400, 2)):
        place = picture.low + (np.array([column, row]) + 0.5) * step
        latitude, longitude = (float(v[0]) for v in shot.ground.geodetic(*place[:, None]))
        x, y = mercator.tile_at(latitude, longitude, area.level)
        if min(x % 1, y % 1, 1 - x % 1, 1 - y % 1) < 0.02:  # two tiles mixed
            continue
        tile = mercantile.tile(longitude, latitude, area.level)
        checked += 1
        wrong += tuple(picture.pixels[row, column]) != (*colour(area.level, tile.x, tile.y), 255)
    assert checked > 300
    assert wrong == 0


def test_the_level_is_fine_enough_for_the_nearest_view(make, tmp_path):
    file = (
        make("photo_size = 6144\n[render]\nresolution = [64, 36]", credit='photo_credit = "A"\n')
        .settings()
        .path
    )
    file.write_text(file.read_text().replace("height = 200.0", "height = 300.0"))  # few and coarse tiles
    shot, told = fetched(ShotSource(scene=str(file)), tmp_path)
    (planned,) = drape_plan.plan(shot, (-180, -85, 180, 85), (0, 30), 256)
    (area,) = drape.of_shot(shot).areas
    assert planned.patch.level == area.level
    assert area.step <= planned.wanted < 2.0 * area.step
    eye = shot.ground.eyes
    above = float((eye[:, 2] - shot.ground.up(*eye[:, :2].T)).min())
    assert planned.wanted < shot.paths[0].pixel * above
    assert any(f"level {area.level} of 19" in text for text in told)


def test_the_nearest_pixel_is_what_brute_force_finds(make, tmp_path):
    shot = make().shot()
    low, high = (np.array(corner) for corner in ((-300.0, -300.0), (300.0, 300.0)))
    pixel = drape_plan.pixel_at_nearest_view(shot, low, high)
    (path,) = shot.paths
    east, north = (v.ravel() for v in np.meshgrid(*(np.linspace(-300.0, 300.0, 301),) * 2))
    place = np.column_stack([east, north, shot.ground.up(east, north)])
    seen = place[shot.visibility.visible_mask(place, 0.01)]
    true = path.pixel * float(shot.visibility.distance_from(path, seen).min())
    assert 0.5 * true < pixel <= true


def test_budgets_are_kept_and_told(make, tmp_path):
    shot, told = fetched(make("photo_size = 300"), tmp_path)
    (area,) = drape.of_shot(shot).areas
    assert max(orthophoto.pictures(shot)[0].pixels.shape) <= 300
    assert any("terrain.photo_size allows no finer level" in text for text in told)
    shot, told = fetched(make("photo_level = 13"), tmp_path)
    assert drape.of_shot(shot).areas[0].level == 13
    assert any("the server has no finer level (terrain.photo_level)" in text for text in told)
    assert area.level < 17


def test_near_the_cameras_a_finer_level_is_shown(make, tmp_path):
    shot, _ = fetched(make("photo_size = 300", near=150.0), tmp_path)
    areas = drape.of_shot(shot).areas
    levels, spans = [each.level for each in areas], [each.high[0] - each.low[0] for each in areas]
    assert len(areas) >= 3
    assert levels == sorted(set(levels))
    assert spans == sorted(spans, reverse=True)
    near, picture = areas[-1], orthophoto.pictures(shot)[-1]
    assert spans[-1] < 2.0 * 150.0 + 1.0
    middle = 0.5 * (picture.low + picture.high)
    latitude, longitude = (float(v[0]) for v in shot.ground.geodetic(*middle[:, None]))
    x, y = (int(v) for v in mercator.tile_at(latitude, longitude, near.level))
    centre = picture.pixels[picture.pixels.shape[0] // 2, picture.pixels.shape[1] // 2]
    assert tuple(centre[:3]) == colour(near.level, x, y)


def test_a_level_that_the_server_lacks_is_not_asked_for_everywhere(make, tmp_path, server):
    server.answers = Tiles(highest=13)
    shot, told = fetched(make("photo_size = 2048"), tmp_path)
    assert drape.of_shot(shot).areas[0].level == 13
    assert any("has no tiles of level 15 here; level 13 is used" in text for text in told)
    assert drape.of_shot(shot).missing == ()
    assert sum("/t/15/" in path or "/t/14/" in path for path in server.asked) <= 10


def test_missing_tiles_are_named(make, tmp_path, server):
    fetched(make(), tmp_path)
    level = max(int(path.split("/")[2]) for path in server.asked)
    gone = sorted(path for path in server.asked if path.startswith(f"/t/{level}/"))[0]
    server.answers.gone = {tuple(int(part) for part in gone[3:-4].split("/"))}
    shot, told = fetched(make(), tmp_path, cache=None)
    assert drape.of_shot(shot).missing == (f"{server.url}{gone}: is not there (status 404)",)
    assert told[-1].startswith(
        "1 tile of the orthophoto missing, replaced by coarser tiles: http://127.0.0.1"
    )


def test_a_second_time_nothing_is_asked_and_the_pictures_are_the_same(make, tmp_path, server):
    shot, _ = fetched(make(), tmp_path)
    first, before = len(server.asked), drape.of_shot(shot)
    fetched(make(), tmp_path)
    assert len(server.asked) == first
    assert drape.of_shot(shot) == before
    fetched(make(), tmp_path, online=False)
    assert drape.of_shot(shot) == before


def test_the_size_of_the_tiles_decides_the_level(make, tmp_path, server):
    small = drape.of_shot(fetched(make(), tmp_path)[0]).areas[0]
    server.answers = Tiles(side=512)
    large = drape.of_shot(fetched(make(), tmp_path, cache=None)[0]).areas[0]
    assert (large.side, large.level) == (512, small.level - 1)
    assert large.step == small.step


def test_credits_come_from_the_settings_of_a_url_and_of_a_file(make, tmp_path):
    choice = make()
    with pytest.raises(InputError, match="was not fetched; build it again"):
        drape.of_shot(choice.shot())
    shot, told = fetched(choice, tmp_path)
    assert picture_credits.of_shot(shot) == Credits(("Somebody", "Somebody else"))
    assert told[0].endswith("which pictures show: Somebody; Somebody else")
    file = make().settings().path
    file.write_text(GROUND_ALONE.format(key=f'photo = "a.tif"\n{CREDIT}', near=0.0, apron=3000.0))
    assert picture_credits.of_settings(ShotSource(scene=str(file)).settings()) == Credits(
        ("Somebody", "Somebody else")
    )
    file.write_text(GROUND_ALONE.format(key=CREDIT, near=0.0, apron=3000.0))
    assert not picture_credits.of_settings(ShotSource(scene=str(file)).settings())  # no photo


@pytest.mark.parametrize(
    ("about", "why"),
    [
        ({"credit": ""}, "terrain.photo_url needs terrain.photo_credit"),
        ({"credit": 'photo_credit = " "\n'}, "terrain.photo_url needs terrain.photo_credit"),
        ({"keys": 'photo = "a.tif"'}, "terrain.photo_url and terrain.photo are both there"),
        ({"host": "https://tile.openstreetmap.org", "path": "/{z}/{x}/{y}.png"}, "forbids bulk downloading"),
        ({"path": "/{z}/{x}.png"}, "must have {z}, {x} and one of {y}"),
        ({"host": "http://a.example"}, "is plain http"),
    ],
)
def test_refused_with_the_line_of_the_key(make, about, why):
    with pytest.raises(InputError) as error:
        make(**about).shot()
    assert why in error.value.reason
    assert error.value.path.endswith("scene.toml")
    assert error.value.line > 0


def test_a_url_as_file_leads_to_the_right_key(make, tmp_path):
    file = make().settings().path
    text = 'photo = "https://a.example/{z}/{x}/{y}.png"'
    file.write_text(GROUND_ALONE.format(key=text, near=0.0, apron=3000.0))
    with pytest.raises(InputError, match=r"named by terrain\.photo_url"):
        ShotSource(scene=str(file)).shot()


def capabilities(server, host=""):
    inner = (
        '<ResourceURL format="image/png" resourceType="tile" template="'
        f'{host or server.url}/t/{{TileMatrix}}/{{TileCol}}/{{TileRow}}.png"/>'
    )
    text = document(layer(inner=inner), matrices(levels=range(16)))
    for level in range(16):
        text = text.replace(f">L{level}<".encode(), f">{level}<".encode())
    server.answers["/wmts"] = Reply(200, text, FRESH)


def test_a_wmts_is_read_from_its_capabilities(make, tmp_path, server):
    capabilities(server)
    shot, told = fetched(make(path="/wmts"), tmp_path)
    assert drape.of_shot(shot).areas[0].level == 13
    assert server.asked[0] == "/wmts"
    assert any("level 13 of 15" in text for text in told)


def test_a_wmts_with_tiles_elsewhere_says_what_to_write(make, tmp_path, server):
    capabilities(server, "https://b.example")
    with pytest.raises(InputError) as error:
        fetched(make(path="/wmts"), tmp_path)
    wanted = "another host; name them as terrain.photo_url: https://b.example/t/{z}/{x}/{y}.png"
    assert wanted in error.value.reason


def test_keys_are_in_no_file_message_and_log(make, tmp_path, server, caplog, monkeypatch):
    monkeypatch.setenv("FIRETWIN_KEY_TILES", "s3cret-of-somebody")
    server.answers.gone = {(3, 1, 3)}
    with caplog.at_level(logging.DEBUG):
        shot, told = fetched(
            make("photo_size = 300", path="/t/{z}/{x}/{y}.png?key=${FIRETWIN_KEY_TILES}"), tmp_path
        )
    assert all(path.endswith("?key=s3cret-of-somebody") for path in server.asked)
    assert "s3cret" not in caplog.text + " ".join(told)
    assert orthophoto.inputs(shot.settings) == {"photo url": f"{server.url}/t/{{z}}/{{x}}/{{y}}.png"}
    for path in tmp_path.rglob("*"):
        if path.is_file():
            assert b"s3cret" not in path.read_bytes(), path


def test_a_tileset_that_is_made_has_these_colours(make, tmp_path):
    shot, _ = fetched(make(), tmp_path)
    assert make_job.default_credit(shot, photo=True).endswith("; Somebody; Somebody else")
    assert "Somebody" not in make_job.default_credit(shot, photo=False)
    colours = make_job._PhotoColours(shot)
    (area,) = drape.of_shot(shot).areas
    x, y = 0.5 + np.floor(mercator.tile_at(38.904, -120.592, area.level))
    latitude, longitude = mercator.place_of(x, y, area.level)
    near = np.array([-1.0e-6, 0.0, 1.0e-6])
    found = colours(latitude + near, longitude + near)
    assert tuple(found[1, 1]) == colour(area.level, int(x), int(y))


def test_the_job_fetches_in_a_process_of_its_own(make, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "home"))
    choice, told = make("photo_size = 300"), []
    imagery.prepare(choice, tell=told.append)
    assert drape.of_shot(choice.shot()).credits == ("Somebody", "Somebody else")
    assert told[0].startswith("credit of the orthophoto")
    assert (tmp_path / "home").exists()


def test_a_transparent_tile_leaves_the_ground_as_it_is(make, tmp_path, server):
    shot, _ = fetched(make("photo_size = 300"), tmp_path)
    (area,) = drape.of_shot(shot).areas
    clear = np.zeros((256, 256, 4), np.uint8)
    server.answers = {
        f"/t/{area.level}/{x}/{y}.png": Reply(200, png(clear), FRESH)
        for x in range(area.column, area.column + 4)
        for y in range(area.row, area.row + 4)
    }
    shot, _ = fetched(make("photo_size = 300"), tmp_path, cache=None)
    assert orthophoto.pictures(shot)[0].pixels[..., 3].max() == 0
