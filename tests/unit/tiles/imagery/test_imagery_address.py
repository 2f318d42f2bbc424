"""Addresses of imagery: rows from either side, rejected templates, and keys of the environment."""

import pytest
from firetwin.errors import InputError
from firetwin.tiles import policies
from firetwin.tiles.imagery import address
from firetwin.tiles.policies import openstreetmap

HTTPS = "https://a.example/{z}/{x}/{y}.png"


def test_rows_count_from_the_north_or_from_the_south():
    assert address.TileAddress(HTTPS).url(5, 3, 7) == "https://a.example/5/3/7.png"
    south = address.TileAddress(HTTPS.replace("{y}", "{-y}"))
    assert south.url(5, 3, 7) == "https://a.example/5/3/24.png"


def test_columns_go_around_the_earth_and_levels_may_have_names():
    found = address.TileAddress(HTTPS, names={4: "EPSG%3A3857%3A4"})
    assert found.url(4, 16, 0) == "https://a.example/EPSG%3A3857%3A4/0/0.png"
    assert found.url(4, -1, 0) == "https://a.example/EPSG%3A3857%3A4/15/0.png"


@pytest.mark.parametrize(
    ("url", "why"),
    [
        ("https://a.example/{z}/{x}.png", "must have {z}, {x} and one of {y} and {-y}"),
        ("https://a.example/{z}/{x}/{y}/{-y}.png", "must have {z}, {x} and one of"),
        ("https://a.example/{z}/{x}/{x}/{y}.png", "each once"),
        ("https://a.example/{z}/{x}/{y}{r}.png", "has {r}; known are"),
        ("https://a.example/{q}.png", "has {q}; known are"),
        ("https://{s}.a.example/{z}/{x}/{y}.png", "has a variable in its host"),
        ("http://a.example/{z}/{x}/{y}.png", "is plain http"),
        ("ftp://a.example/{z}/{x}/{y}.png", "only https is"),
        ("https://me@a.example/{z}/{x}/{y}.png", "has a user name"),
        ("https://tile.openstreetmap.org/{z}/{x}/{y}.png", "forbids bulk downloading"),
        ("https://a.tile.openstreetmap.org/{z}/{x}/{y}.png", "forbids bulk downloading"),
        ("https://tile.googleapis.com/v1/2dtiles/{z}/{x}/{y}", "its terms forbid to keep its pictures"),
        ("https://api.cesium.com/{z}/{x}/{y}.png", "name them in tiles.sources"),
    ],
)
def test_refused(url, why):
    with pytest.raises(InputError) as error:
        address.check(url)
    assert why in error.value.reason


def test_openstreetmap_may_not_be_draped_and_others_may():
    assert policies.for_host("tile.openstreetmap.org") is openstreetmap.POLICY
    assert not policies.OPEN.no_drape
    address.check("http://127.0.0.1:8000/{z}/{x}/{y}.png")
    address.check("https://a.example/{z}/{x}/{y}.png?key=${FIRETWIN_KEY_TILES}")
    address.check("https://a.example/wmts?request=GetCapabilities")
    assert not address.is_template("https://a.example/wmts?key=${FIRETWIN_KEY_TILES}")


@pytest.mark.parametrize("name", ["HOME", "AWS_SECRET_ACCESS_KEY", "GOOGLE_MAPS_API_KEY", "CESIUM_ION_TOKEN"])
def test_a_scene_file_cannot_send_other_variables_to_a_host(monkeypatch, name):
    monkeypatch.setenv(name, "s3cret-value")
    for call in (address.check, address.with_variables):
        with pytest.raises(InputError, match=f"variable {name}; only FIRETWIN_KEY_") as error:
            call(HTTPS + f"?key=${{{name}}}")
        assert "s3cret" not in str(error.value)


def test_a_password_in_a_url_is_not_printed():
    for call in (address.check, address.with_variables):
        with pytest.raises(InputError, match="has a user name") as error:
            call("https://me:s3cret@a.example/{z}/{x}/{y}.png")
        assert "s3cret" not in str(error.value)


def test_keys_come_from_the_environment_into_secret_parameters_alone(monkeypatch):
    monkeypatch.setenv("FIRETWIN_KEY_TILES", "s3cret-value")
    assert address.with_variables(HTTPS + "?key=${FIRETWIN_KEY_TILES}") == HTTPS + "?key=s3cret-value"
    for wrong in (
        "https://a.example/${FIRETWIN_KEY_TILES}/{z}/{x}/{y}.png",
        HTTPS + "?colour=${FIRETWIN_KEY_TILES}",
    ):
        with pytest.raises(InputError, match="not the complete value of a parameter") as error:
            address.with_variables(wrong)
        assert "s3cret" not in str(error.value)
    with pytest.raises(InputError, match="needs the environment variable FIRETWIN_KEY_NONE"):
        address.with_variables(HTTPS + "?key=${FIRETWIN_KEY_NONE}")
