"""Decoded tiles as files: flat arrays, and pictures as they came, named by their content.

A file is a line of text, the length of a JSON header, the header, and the arrays one after the other, each in
the order and type of `_ARRAYS`. It is read at once, without copies.
"""

from __future__ import annotations

import hashlib
import json
import struct
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..errors import input_error
from . import point_spacing

if TYPE_CHECKING:
    from firetwin_core import tiles

END = ".tile"
"""End of the files' names."""
_FIRST = b"Firetwin tile 1\n"
_ARRAYS = {
    "origin": ("<f8", "one", 3),
    "position": ("<f4", "vertices", 3),
    "normal": ("<f4", "vertices", 3),
    "uv": ("<f4", "vertices", 2),
    "colour": ("<f4", "colours", 4),
    "triangle": ("<i4", "triangles", 3),
    "material_index": ("<i4", "triangles", 1),
}
"""Type of each array, the number in the header that is its length, and its width."""
_ENDS = {"jpeg": ".jpg", "png": ".png", "webp": ".webp"}


@dataclass(frozen=True)
class Material:
    """Material of a range of triangles.

    Attributes
    ----------
    colour
        Linear red, green, blue and alpha, multiplied with colours of the picture and the vertices.
    picture
        File of the picture; empty: none.
    wrap
        "repeat", "clamp" or "mirror" beyond the picture.
    alpha
        "opaque", "mask" or "blend".
    """

    colour: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    picture: str = ""
    wrap: str = "repeat"
    alpha: str = "opaque"


@dataclass(frozen=True)
class TileSummary:
    """Numbers of a decoded tile.

    Attributes
    ----------
    points
        Number of vertices at the end that are points of a cloud, without triangles.
    spacing
        Distance of neighbouring points, m; 0 without points.
    credit
        Copyright notices, with semicolons between them.
    """

    vertices: int
    triangles: int
    points: int
    spacing: float
    credit: str


@dataclass(frozen=True)
class Decoded:
    """A tile's triangles and points in the scene.

    Attributes
    ----------
    origin
        (3,) m in the scene.
    position, normal
        (n, 3) float32 m about the origin, and unit vectors.
    uv
        (n, 2) float32 from the picture's lower left corner.
    colour
        (n, 4) float32, linear; (0, 4) without.
    triangle
        (m, 3) vertex numbers.
    material_index
        (m,) numbers in `materials`.
    """

    origin: NDArray[np.float64]
    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    uv: NDArray[np.float32]
    colour: NDArray[np.float32]
    triangle: NDArray[np.int32]
    material_index: NDArray[np.int32]
    materials: tuple[Material, ...]
    about: TileSummary

    @property
    def credit(self) -> str:
        """Copyright notices, with semicolons between them."""
        return self.about.credit

    @property
    def pictures(self) -> list[str]:
        """Files of the pictures, without duplicates."""
        return list(dict.fromkeys(each.picture for each in self.materials if each.picture))

    def without_points(self) -> Decoded:
        """Return the tile without its points."""
        left = len(self.position) - self.about.points
        return replace(
            self,
            position=self.position[:left],
            normal=self.normal[:left],
            uv=self.uv[:left],
            colour=self.colour[:left],
            about=replace(self.about, vertices=left, points=0),
        )


def write(tile: tiles.Tile, path: Path, resources: dict[str, bytes]) -> None:
    """Write a decoded tile to `path`, and its pictures into the same folder.

    Parameters
    ----------
    resources
        External files of the content by URI, for external pictures.
    """
    pictures = [_store_picture(each, path.parent, resources) for each in tile.images]
    materials: list[dict[str, Any]] = [
        {
            "colour": list(each.colour),
            "picture": pictures[each.image] if each.image >= 0 else "",
            "wrap": each.wrap_u,
            "alpha": each.alpha_mode,
        }
        for each in tile.materials
    ]
    index = np.zeros(len(tile.triangle), np.int32)
    for part in tile.ranges:
        last = part.first_triangle + part.triangles
        index[part.first_triangle : last] = part.material if part.material >= 0 else len(materials)
    if not len(materials) or index.max(initial=0) == len(materials):
        materials.append({})
    points = sum(part.vertices for part in tile.ranges if part.points)
    about = {
        "one": 1,
        "vertices": len(tile.position),
        "colours": len(_vertex_colours(tile)),
        "triangles": len(tile.triangle),
        "points": points,
        "spacing": point_spacing.estimate(tile.position[len(tile.position) - points :]),
        "materials": materials,
        "credit": tile.copyright,
    }
    arrays = {name: getattr(tile, name) for name in _ARRAYS if name != "material_index"}
    arrays |= {"material_index": index, "colour": _vertex_colours(tile)}
    header = json.dumps(about).encode()
    header += b" " * (-(len(_FIRST) + 4 + len(header)) % 8)

    def put(part: Path) -> None:
        with part.open("wb") as stream:
            stream.write(_FIRST + struct.pack("<I", len(header)) + header)
            for name, (kind, _, _) in _ARRAYS.items():
                stream.write(np.asarray(arrays[name], kind).tobytes())

    files.write(path, put, durable=False)


def _vertex_colours(tile: tiles.Tile) -> NDArray[np.float32]:
    """Compute vertex colours; colours of points include the colour of their material."""
    tints = [
        (part, np.asarray(tile.materials[part.material].colour, np.float32))
        for part in tile.ranges
        if part.points and part.material >= 0
    ]
    if not tints:
        return tile.colour
    colour = tile.colour.copy() if len(tile.colour) else np.ones((len(tile.position), 4), np.float32)
    for part, tint in tints:
        colour[part.first_vertex : part.first_vertex + part.vertices] *= tint
    return colour


def read_summary(path: Path) -> TileSummary | None:
    """Read the numbers of a decoded tile; None if the file is missing or incomplete."""
    try:
        with path.open("rb") as stream:
            about, start = _header(stream.read(len(_FIRST) + 4), stream.read)
            if start + _array_bytes(about) != path.stat().st_size:
                return None
            return _summary(about)
    except (OSError, ValueError, LookupError, TypeError, struct.error):
        return None


def read(path: Path) -> Decoded:
    """Read a decoded tile.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        data = path.read_bytes()
        at = len(_FIRST) + 4
        about, start = _header(data[:at], lambda count: data[at : at + count])
        if start + _array_bytes(about) != len(data):
            raise ValueError("unexpected length")
        arrays = {}
        for name, (kind, length, width) in _ARRAYS.items():
            array = np.frombuffer(data, kind, about[length] * width, start)
            start += array.nbytes
            arrays[name] = array.reshape(-1, width) if width > 1 and length != "one" else array
        materials = tuple(
            Material(**each | {"colour": tuple(each["colour"])} if each else {})
            for each in about["materials"]
        )
        found = Decoded(**arrays, materials=materials, about=_summary(about))
    except (OSError, ValueError, LookupError, TypeError, struct.error) as error:
        raise input_error(path, f"is not a decoded tile ({error}); delete it") from None
    if not _is_consistent(found):
        raise input_error(path, "is not a decoded tile (inconsistent numbers); delete it")
    return found


def _header(first: bytes, read: Any) -> tuple[dict[str, Any], int]:
    """Read the header; return it and the offset of the arrays."""
    if not first.startswith(_FIRST):
        raise ValueError("unexpected signature")
    (length,) = struct.unpack("<I", first[len(_FIRST) :])
    return json.loads(read(length)), len(first) + length


def _array_bytes(about: dict[str, Any]) -> int:
    """Sum the bytes of all arrays."""
    return sum(about[length] * width * np.dtype(kind).itemsize for kind, length, width in _ARRAYS.values())


def _summary(about: dict[str, Any]) -> TileSummary:
    names = ("vertices", "triangles", "points", "spacing", "credit")
    return TileSummary(*(about[name] for name in names))


def picture_names(path: Path) -> set[str]:
    """Read the names of a decoded tile's pictures; empty if the file cannot be read."""
    try:
        with path.open("rb") as stream:
            about, _ = _header(stream.read(len(_FIRST) + 4), stream.read)
        return {each["picture"] for each in about["materials"] if each.get("picture")}
    except (OSError, ValueError, LookupError, TypeError, AttributeError, struct.error):
        return set()


def _is_consistent(tile: Decoded) -> bool:
    """Test whether the vertices and materials of all triangles exist."""
    count = len(tile.position)
    if len(tile.colour) not in (0, count) or not 0 <= tile.about.points <= count:
        return False
    if not len(tile.triangle):
        return True
    numbers = tile.triangle.min() >= 0 and tile.triangle.max() < count
    return bool(
        numbers and tile.material_index.min() >= 0 and tile.material_index.max() < len(tile.materials)
    )


def _store_picture(image: tiles.Image, folder: Path, resources: dict[str, bytes]) -> str:
    """Write a picture's file unless it exists; return its name."""
    data = image.data or resources.get(image.uri, b"")
    if not data or image.kind not in _ENDS:
        return ""
    path = folder / f"{hashlib.sha256(data).hexdigest()[:32]}{_ENDS[image.kind]}"
    files.write_cached(path, data)
    return path.name
