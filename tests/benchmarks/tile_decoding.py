"""Decoding of a made tile of 3-D Tiles: milliseconds and bytes, raw and compressed.

    python tests/benchmarks/tile_decoding.py [--side 50] [--runs 50]

The tile is a wavy surface of 2 x SIDE x SIDE triangles with normals, texture coordinates and a picture
of 60 KB.
`raw` has float32 attributes, `no normals` lets the decoder make them, `Draco` has positions of 14 bits.
Times are the least and the median of RUNS, of the processor, on one thread.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from firetwin_core import tiles

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))
import tile_files as made

PICTURE = made.jpeg(512, 512) + bytes(60_000)


def raw(side: int, normals: bool = True) -> bytes:
    """A b3dm of float32 attributes."""
    position, normal, uv, triangles = made.wavy(side)
    content = textured()
    named = {"TEXCOORD_0": uv} | ({"NORMAL": normal} if normals else {})
    content.node(content.mesh(content.primitive(position, triangles, named, material=0)))
    return made.b3dm(content.scene().glb())


def draco(side: int) -> bytes:
    """The same, compressed."""
    import DracoPy

    position, normal, uv, triangles = made.wavy(side)
    options = {"quantization_bits": 14, "normals": normal.astype(float), "tex_coord": uv.astype(float)}
    data = DracoPy.encode(position, triangles, **options)
    mesh = DracoPy.decode(data)
    ids = {attribute["attribute_type"]: attribute["unique_id"] for attribute in mesh.attributes}
    content = textured()

    def said(count: int, kind: str, component: int = 5126) -> int:
        return content.add("accessors", {"count": count, "type": kind, "componentType": component})

    n = len(mesh.points)
    named = {"POSITION": said(n, "VEC3"), "NORMAL": said(n, "VEC3"), "TEXCOORD_0": said(n, "VEC2")}
    extension = {
        "bufferView": content.view(data),
        "attributes": {"POSITION": ids[0], "NORMAL": ids[1], "TEXCOORD_0": ids[3]},
    }
    primitive = {
        "attributes": named,
        "indices": said(3 * len(mesh.faces), "SCALAR", 5125),
        "material": 0,
        "extensions": {"KHR_draco_mesh_compression": extension},
    }
    content.node(content.mesh(primitive))
    return made.b3dm(content.scene().glb())


def textured() -> made.Gltf:
    """A document with one material and its picture."""
    content = made.Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
    content.json |= {"textures": [{"source": 0}], "images": [{"bufferView": content.view(PICTURE)}]}
    return content


def measure(content: bytes, runs: int) -> tuple[float, float]:
    """Least and median ms of decoding."""
    matrix, took = np.eye(4), []
    for _ in range(runs):
        began = time.process_time()
        tiles.decode(content, matrix, "tile")
        took.append(1e3 * (time.process_time() - began))
    return min(took), float(np.median(took))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--side", type=int, default=50, help="squares of a side (50: 5,000 triangles)")
    parser.add_argument("--runs", type=int, default=50)
    given = parser.parse_args()
    made_of = {"raw": raw(given.side), "no normals": raw(given.side, False), "Draco": draco(given.side)}
    result = {}
    for name, content in made_of.items():
        least, median = measure(content, given.runs)
        result[name] = {"bytes": len(content), "least_ms": round(least, 3), "median_ms": round(median, 3)}
    print(json.dumps({"triangles": 2 * given.side**2, **result}, indent=2))


if __name__ == "__main__":
    main()
