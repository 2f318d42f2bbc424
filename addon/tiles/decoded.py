"""Decoded tiles as files: flat arrays in one .npz, and pictures as they came, named by their content."""

from __future__ import annotations

import hashlib
import json
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..errors import input_error

if TYPE_CHECKING:
    from firetwin_core import tiles

_ARRAYS = ("origin", "position", "normal", "uv", "colour", "triangle", "material_index")
_ENDS = {"jpeg": ".jpg", "png": ".png", "webp": ".webp"}


@dataclass(frozen=True)
class Material:
    """Material of a range of triangles.

    Attributes
    ----------
    colour
        Linear red, green, blue and alpha, multiplied with the picture's and the vertices'.
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
class Decoded:
    """A tile's triangles in the scene.

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
    credit
        Copyright notices, with semicolons between them.
    """

    origin: NDArray[np.float64]
    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    uv: NDArray[np.float32]
    colour: NDArray[np.float32]
    triangle: NDArray[np.int32]
    material_index: NDArray[np.int32]
    materials: tuple[Material, ...]
    credit: str

    @property
    def pictures(self) -> list[str]:
        """Files of its pictures, each once."""
        return list(dict.fromkeys(each.picture for each in self.materials if each.picture))


def write(tile: tiles.Tile, path: Path, resources: dict[str, bytes]) -> None:
    """Write a decoded tile to `path`, and its pictures beside it.

    Parameters
    ----------
    resources
        Files beside the content by uri, for pictures that lie there.
    """
    pictures = [_store(each, path.parent, resources) for each in tile.images]
    materials = [
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
    about = np.frombuffer(json.dumps({"materials": materials, "credit": tile.copyright}).encode(), np.uint8)
    arrays: dict[str, NDArray] = {
        "about": about,
        "origin": tile.origin,
        "position": tile.position,
        "normal": tile.normal,
        "uv": tile.uv,
        "colour": tile.colour,
        "triangle": tile.triangle.astype(np.int32),
        "material_index": index,
    }

    def put(part: Path) -> None:
        with part.open("wb") as stream:
            np.savez(stream, allow_pickle=False, **arrays)

    files.write(path, put)


def read(path: Path) -> Decoded:
    """Read a decoded tile.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            about: dict[str, Any] = json.loads(stored["about"].tobytes())
            arrays = {name: stored[name] for name in _ARRAYS}
        materials = tuple(
            Material(**each | {"colour": tuple(each["colour"])} if each else {})
            for each in about["materials"]
        )
        found = Decoded(**arrays, materials=materials, credit=about["credit"])
    except (OSError, ValueError, LookupError, TypeError, zipfile.BadZipFile) as error:
        raise input_error(path, 0, 0, f"is no decoded tile ({error}); delete it") from None
    if not _is_consistent(found):
        raise input_error(path, 0, 0, "is no decoded tile: its numbers do not fit together; delete it")
    return found


def pictures(path: Path) -> set[str]:
    """Names of the pictures that a decoded tile's file names; none where it cannot be read."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            about: dict[str, Any] = json.loads(stored["about"].tobytes())
        return {each["picture"] for each in about["materials"] if each.get("picture")}
    except (OSError, ValueError, LookupError, TypeError, AttributeError, zipfile.BadZipFile):
        return set()


def _is_consistent(tile: Decoded) -> bool:
    """Whether every triangle names vertices and a material that exist."""
    count = len(tile.position)
    shapes = tile.position.shape == tile.normal.shape == (count, 3) and tile.uv.shape == (count, 2)
    inside = tile.triangle.shape[1:] == (3,) and tile.material_index.shape == (len(tile.triangle),)
    if not (shapes and inside and tile.colour.shape in ((0, 4), (count, 4)) and tile.origin.shape == (3,)):
        return False
    if not len(tile.triangle):
        return True
    numbers = tile.triangle.min() >= 0 and tile.triangle.max() < count
    return bool(
        numbers and tile.material_index.min() >= 0 and tile.material_index.max() < len(tile.materials)
    )


def _store(image: tiles.Image, folder: Path, resources: dict[str, bytes]) -> str:
    """Name of a picture's file, which is written where it is new."""
    data = image.data or resources.get(image.uri, b"")
    if not data or image.kind not in _ENDS:
        return ""
    path = folder / f"{hashlib.sha256(data).hexdigest()[:32]}{_ENDS[image.kind]}"
    if not path.exists():
        files.write(path, lambda part: part.write_bytes(data))
    return path.name
