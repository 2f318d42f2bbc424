"""Small tilesets with everything that a tileset may have."""

from tilesets import GLB, box, subtree, tile, tileset

_REGION = {"region": [-2.1041, 0.6797, -2.1039, 0.6799, 0.0, 100.0]}
_SHIFT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1]
_SCHEMA = {
    "classes": {
        "t": {
            "properties": {
                "e": {"type": "SCALAR", "componentType": "FLOAT64", "semantic": "TILE_GEOMETRIC_ERROR"},
                "b": {
                    "type": "SCALAR",
                    "componentType": "FLOAT64",
                    "array": True,
                    "count": 4,
                    "semantic": "TILE_BOUNDING_SPHERE",
                },
            }
        }
    }
}
_OWN = {"class": "t", "properties": {"e": 5.0, "b": [0, 0, 0, 3]}}


def _implicit(scheme, error, volume):
    dimensions = ["{x}", "{y}"] + (["{z}"] if scheme == "OCTREE" else [])
    name = ".".join(["{level}", *dimensions])
    own = {"subdivisionScheme": scheme, "subtreeLevels": 2, "availableLevels": 3}
    return tile(
        error,
        f"c/{name}.glb",
        volume=volume,
        refine="REPLACE",
        implicitTiling=own | {"subtrees": {"uri": f"s/{name}.subtree"}},
    )


def _table():
    """A subtree whose property table gives each tile an error."""
    more = {
        "tileMetadata": 0,
        "propertyTables": [{"class": "t", "count": 5, "properties": {"e": {"values": 1}}}],
    }
    return subtree([1] * 5, [1], [1] + [0] * 15, more, bytes(8 * 5))


SAMPLES = {
    "explicit": {
        "tileset.json": tileset(
            tile(
                100.0,
                "r.glb",
                [
                    tile(
                        10.0,
                        None,
                        transform=_SHIFT,
                        viewerRequestVolume={"sphere": [0, 0, 0, 5]},
                        contents=[{"uri": "a.glb", "boundingVolume": box()}, {"uri": "b.glb"}],
                        metadata=_OWN,
                    ),
                    tile(12.0, "sub.json", [], _REGION),
                ],
                refine="ADD",
            ),
            schema=_SCHEMA,
        ),
        "sub.json": tileset(tile(3.0, "c.glb", [tile(1.0, "d.glb")], refine="REPLACE")),
        **{f"{each}.glb": GLB for each in "rabcd"},
    },
    "implicit quadtree": {
        "tileset.json": tileset(_implicit("QUADTREE", 16.0, _REGION), schema=_SCHEMA),
        "s/0.0.0.subtree": _table(),
        "s/2.0.0.subtree": subtree([1, 0, 0, 0, 0], [1], 0),
        "c/0.0.0.glb": GLB,
    },
    "implicit octree": {
        "tileset.json": tileset(_implicit("OCTREE", 16.0, box())),
        "s/0.0.0.0.subtree": subtree([1, 1, 0, 0, 0, 0, 0, 0, 1], [[1] * 9], [1] + [0] * 63),
        "s/2.0.0.0.subtree": subtree(1, [0], 0),
    },
}
