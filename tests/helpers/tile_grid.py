"""A set of 3D tiles of any number: a coarse root, and a square grid of wavy pieces with a picture each."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import tile_files as made
from firetwin.tiles.place import ecef_to_frame
from PIL import Image

PIECE = 100.0
"""m, side of a piece."""


def write(folder: Path, frame, count: int, side: int, above: float = 1500.0) -> None:
    """Write tileset.json and `count` pieces of 2 x side x side triangles about the origin of a scene.

    Parameters
    ----------
    above
        Height of the middle of the pieces in the scene, m.
    """
    folder.mkdir(parents=True, exist_ok=True)
    across = int(np.ceil(np.sqrt(count)))
    children = []
    for number in range(count):
        east, north = ((k - 0.5 * across) * PIECE for k in (number % across, number // across))
        (folder / f"{number}.glb").write_bytes(piece(number, side))
        children.append(_tile(east, north, above, f"{number}.glb"))
    half = 0.5 * across * PIECE
    root = {
        "boundingVolume": {"box": [0, 0, above, half, 0, 0, 0, half, 0, 0, 0, 50]},
        "geometricError": 1000.0,
        "refine": "ADD",
        "transform": np.linalg.inv(ecef_to_frame(frame)).T.ravel().tolist(),
        "children": children,
    }
    about = {"asset": {"version": "1.1"}, "geometricError": 2000.0, "root": root}
    (folder / "tileset.json").write_text(json.dumps(about))


def _tile(east: float, north: float, up: float, uri: str) -> dict:
    matrix = np.eye(4)
    matrix[:3, 3] = east, north, up
    half = 0.5 * PIECE
    return {
        "boundingVolume": {"box": [half, half, 0, half, 0, 0, 0, half, 0, 0, 0, 20]},
        "geometricError": 0.0,
        "transform": matrix.T.ravel().tolist(),
        "content": {"uri": uri},
    }


def piece(number: int, side: int) -> bytes:
    """A glb of a wavy square with a separate picture."""
    step = np.linspace(0.0, PIECE, side + 1, dtype=np.float32)
    x, y = (v.ravel() for v in np.meshgrid(step, step))
    z = 5.0 * np.sin(0.1 * x + number) * np.cos(0.07 * y)
    position = np.column_stack([x, z, -y]).astype(np.float32)  # glTF has y up
    uv = np.column_stack([x, PIECE - y]).astype(np.float32) / np.float32(PIECE)
    corner = np.arange((side + 1) * side).reshape(side, side + 1)[:, :-1].ravel()
    low, high = corner, corner + side + 1
    triangles = np.concatenate([np.stack(t, 1) for t in ((low, low + 1, high), (low + 1, high + 1, high))])
    content = made.Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
    content.json |= {"textures": [{"source": 0}], "images": [{"bufferView": content.view(_picture(number))}]}
    content.json["images"][0]["mimeType"] = "image/jpeg"
    attributes = {"TEXCOORD_0": uv}
    content.node(
        content.mesh(content.primitive(position, triangles.astype(np.uint16), attributes, material=0))
    )
    return content.scene().glb()


def _picture(number: int) -> bytes:
    rng = np.random.default_rng(number)
    coarse = rng.integers(60, 200, (16, 16, 3), np.uint8)
    stream = io.BytesIO()
    Image.fromarray(coarse).resize((256, 256)).save(stream, "JPEG")
    return stream.getvalue()
