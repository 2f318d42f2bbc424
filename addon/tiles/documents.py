"""Head of a tileset.json: version, extensions and enclosing tilesets."""

from __future__ import annotations

from collections.abc import Callable

from .. import limits
from . import metadata
from .json_text import Node
from .tree import Document, Tree

VERSIONS = ("0.0", "1.0", "1.1")
KNOWN_EXTENSIONS = {
    "3DTILES_content_gltf",
    "3DTILES_implicit_tiling",
    "3DTILES_metadata",
    "3DTILES_multiple_contents",
}
MOST_NESTED = limits.TILE_NESTED


def is_tileset(node: Node) -> bool:
    """Test whether a JSON text is a tileset, not a glTF or another format."""
    return isinstance(node.value, dict) and ("root" in node or "geometricError" in node)


def read(tree: Tree, node: Node, uri: str, holder: int, load: Callable[[str], Node | None]) -> Document:
    asset = node.need("asset")
    version = asset.need("version").text()
    if version not in VERSIONS:
        raise asset.error(f"version {version[:40]!r} is not one of {', '.join(VERSIONS)}")
    if (required := node.get("extensionsRequired")) is not None:
        for each in required.items():
            if each.text() not in KNOWN_EXTENSIONS:
                raise each.error(f"the required extension {each.text()[:80]!r} is not known to Firetwin")
    above = tree.documents[int(tree.document[holder])].chain if holder >= 0 else ()
    if uri in above:
        raise node.error("the tileset contains itself, through other tilesets")
    if len(above) >= MOST_NESTED:
        raise node.error(f"more than {MOST_NESTED} tilesets in one another")
    up_axis = asset.get("gltfUpAxis")
    text = asset.get("copyright")
    return Document(
        uri,
        node.file,
        (*above, uri),
        up_axis.text().upper() if up_axis is not None else "Y",
        text.text() if text is not None else "",
        metadata.schema_of(node, load),
    )
