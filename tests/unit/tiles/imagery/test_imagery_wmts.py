"""Capabilities of a WMTS: layers, the one matrix set that is read, and both ways to ask for tiles."""

import pytest
from firetwin.errors import InputError
from firetwin.tiles.imagery import wmts
from wmts_text import FORMAT, RESOURCE, document, layer, matrices

URL = "https://a.example/wmts/1.0.0/WMTSCapabilities.xml?map=hills"


def read(*inside, wanted="", **about):
    return wmts.address_of(document(*inside, **about), "a server", URL, wanted)


def test_a_template_is_filled_in_and_levels_have_their_names():
    found = read(layer(), matrices())
    assert found.url(3, 5, 2) == ("https://a.example/t/photo-plain/2014-09/GoogleMapsCompatible/L3/2/5.png")
    assert (found.lowest, found.highest) == (0, 3)
    assert found.bounds == (-125.0, pytest.approx(-85.0511287798), -114.0, 42.5)


def test_tiles_by_keys_and_values():
    operation = (
        '<ows:OperationsMetadata><ows:Operation name="GetTile"><ows:DCP><ows:HTTP>'
        '<ows:Get xlink:href="https://a.example/kvp?map=hills&amp;"/></ows:HTTP></ows:DCP></ows:Operation>'
        "</ows:OperationsMetadata>"
    )
    found = read(layer(inner=FORMAT), matrices(), operation=operation).url(2, 1, 3)
    assert found.startswith("https://a.example/kvp?map=hills&service=WMTS&request=GetTile&version=1.0.0&")
    assert (
        "layer=photo&format=image%2Fpng&style=plain&tilematrixset=GoogleMapsCompatible&time=2014-09" in found
    )
    assert found.endswith("&tilematrix=L2&tilerow=3&tilecol=1")
    without = read(layer(inner=FORMAT), matrices()).url(2, 1, 3)
    assert without.startswith("https://a.example/wmts/1.0.0/WMTSCapabilities.xml?map=hills&service=WMTS&")


def test_a_set_is_known_by_its_numbers_also_with_tiles_of_512_pixels():
    found = read(layer(sets=("a", "b")), matrices("a", crs="EPSG:25832"), matrices("b", "EPSG:3857"))
    assert "/b/L1/" in found.url(1, 0, 0)
    large = read(layer(sets=("c",)), matrices("c", scale=559082264.0287178 / 2, side=512, levels=range(3)))
    assert (large.lowest, large.highest) == (0, 2)
    some = read(layer(), matrices(levels=(9, 10, 11)))
    assert (some.lowest, some.highest) == (9, 11)


@pytest.mark.parametrize(
    "other",
    [
        {"crs": "urn:ogc:def:crs:EPSG::25832"},
        {"crs": "urn:ogc:def:crs:OGC:1.3:CRS84"},
        {"scale": 5.0e8},
        {"corner": "-18000000 9000000"},
        {"corner": "nothing"},
        {"side": 300},
    ],
)
def test_other_matrix_sets_are_refused_by_name(other):
    with pytest.raises(InputError, match=r"has tiles in UTM-32; only WebMercatorQuad"):
        read(layer(sets=("UTM-32",)), matrices("UTM-32", **other))


def test_layers_are_chosen_by_name():
    two = layer("map"), layer("photo"), matrices()
    assert "dark" not in read(*two, wanted="map").template
    with pytest.raises(
        InputError, match=r"has 2 layers; name one of them: map, photo \(terrain.photo_layer\)"
    ):
        read(*two)
    with pytest.raises(InputError, match='has no layer "phot": map, photo'):
        read(*two, wanted="phot")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (b"<html><body>log in</body></html>", "Contents is missing"),
        (b"not xml", "is not WMTS capabilities"),
        (b"", "is not WMTS capabilities"),
        (b'<!DOCTYPE a [<!ENTITY b "cccc">]><a>&b;</a>', "document type"),
        (document(), "has no layer"),
        (document(layer(inner=RESOURCE.format(kind="png").replace("Time", "Season")), matrices()), "Season"),
        (document(layer(inner="<Format>image/webp</Format>"), matrices()), "PNG and JPEG are read"),
        (document(layer(), matrices(levels=())), "has no level"),
    ],
)
def test_refused(text, why):
    with pytest.raises(InputError) as error:
        wmts.address_of(text, "a server", URL)
    assert why in error.value.reason
