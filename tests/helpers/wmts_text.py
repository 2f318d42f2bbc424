"""Texts of WMTS capabilities: matrix sets, layers and documents."""

RESOURCE = (
    '<ResourceURL format="image/{kind}" resourceType="tile"'
    ' template="https://a.example/t/{{Layer}}{{Style}}/{{Time}}/{{TileMatrixSet}}/{{TileMatrix}}/{{TileRow}}/{{TileCol}}.{kind}"/>'
).replace("{{Layer}}", "photo-")
FORMAT = "<Format>image/png</Format>"
ORIGIN = "-20037508.3428 20037508.3428"


def matrices(name="GoogleMapsCompatible", crs="urn:ogc:def:crs:EPSG::3857", levels=range(4), **about):
    """A matrix set."""
    about = {"scale": 559082264.0287178, "side": 256, "corner": ORIGIN} | about
    each = "".join(
        f"<TileMatrix><ows:Identifier>L{z}</ows:Identifier>"
        f"<ScaleDenominator>{about['scale'] / 2**z!r}</ScaleDenominator>"
        f"<TopLeftCorner>{about['corner']}</TopLeftCorner><TileWidth>{about['side']}</TileWidth>"
        f"<TileHeight>{about['side']}</TileHeight></TileMatrix>"
        for z in levels
    )
    return (
        f"<TileMatrixSet><ows:Identifier>{name}</ows:Identifier>"
        f"<ows:SupportedCRS>{crs}</ows:SupportedCRS>{each}</TileMatrixSet>"
    )


def layer(name="photo", sets=("GoogleMapsCompatible",), inner=None):
    links = "".join(
        f"<TileMatrixSetLink><TileMatrixSet>{each}</TileMatrixSet></TileMatrixSetLink>" for each in sets
    )
    inner = RESOURCE.format(kind="png") if inner is None else inner
    return (
        f"<Layer><ows:Identifier>{name}</ows:Identifier>"
        "<ows:WGS84BoundingBox><ows:LowerCorner>-125 -90</ows:LowerCorner>"
        "<ows:UpperCorner>-114 42.5</ows:UpperCorner></ows:WGS84BoundingBox>"
        "<Style><ows:Identifier>dark</ows:Identifier></Style>"
        '<Style isDefault="true"><ows:Identifier>plain</ows:Identifier></Style>'
        "<Dimension><ows:Identifier>Time</ows:Identifier><Default>2014-09</Default></Dimension>"
        f"{links}{inner}</Layer>"
    )


def document(*inside, operation=""):
    return (
        '<?xml version="1.0"?><Capabilities xmlns="http://www.opengis.net/wmts/1.0" '
        'xmlns:ows="http://www.opengis.net/ows/1.1" xmlns:xlink="http://www.w3.org/1999/xlink">'
        f"{operation}<Contents>{''.join(inside)}</Contents></Capabilities>"
    ).encode()
