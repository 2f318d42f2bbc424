"""Contents of 3D Tiles that fuzzing starts from, in the parts that fuzz_*.cpp puts together."""

import base64
import json
import struct

POSITIONS = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
INDICES = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
SQUEEZED = b"\xa0\x01!" + bytes(6) + b"\x01\x08" + bytes(42)  # four vertices by meshoptimizer
SQUEEZED_INDICES = b"\xe1\xf0\0\0v\x87Vgx\xa9\x86e\x89h\x98\x01i\0\0"
PNG = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x07\0\0\0\x09\x08\x02\0\0\0"
JPEG = b"\xff\xd8\xff\xe0\0\x04ab\xff\xc0\0\x11\x08\0\x07\0\x09" + bytes(12)
WEBP = b"RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\x06\0\0\x08\0\0"
TABLE_3 = {"POINTS_LENGTH": 3, "POSITION": {"byteOffset": 0}, "RTC_CENTER": [1, 2, 3]}


def compact(document):
    return json.dumps(document, separators=(",", ":")).encode()


def document(primitive=None, data=POSITIONS + INDICES, views=((0, 48), (48, 12)), **more):
    """A square of two triangles; views are offsets and lengths, or whole descriptions."""
    described = [
        v if isinstance(v, dict) else {"buffer": 0, "byteOffset": v[0], "byteLength": v[1]} for v in views
    ]
    base = {
        "asset": {"version": "2.0", "copyright": "A;B"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, **(primitive or {})}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": described,
        "buffers": [{"byteLength": len(data)}],
    }
    return compact(base | more) + b"\n" + data


def textured(picture):
    data = POSITIONS + INDICES + picture
    views = ((0, 48), (48, 12), (60, len(picture)))
    moved = {"KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1, "scale": [2, 2]}}
    material = {"baseColorTexture": {"index": 0, "extensions": moved}, "baseColorFactor": [1, 0, 0, 1]}
    return document(
        {"material": 0},
        data,
        views,
        materials=[{"pbrMetallicRoughness": material, "alphaMode": "MASK"}],
        textures=[{"source": 0, "sampler": 0}],
        samplers=[{"wrapS": 33071}],
        images=[{"bufferView": 2}],
    )


def squeezed(offset, size, stride, count, mode, **more):
    """A view that meshopt compressed."""
    extension = {"buffer": 0, "byteOffset": offset, "byteLength": size, "byteStride": stride, "count": count}
    extension |= {"mode": mode, **more}
    described = {"buffer": 0, "byteLength": stride * count}
    return described | {"extensions": {"EXT_meshopt_compression": extension}}


def documents():
    """JSON, a newline and the binary chunk."""
    views = [
        squeezed(0, 53, 12, 4, "ATTRIBUTES", filter="EXPONENTIAL"),
        squeezed(53, 19, 4, 6, "TRIANGLES"),
    ]
    four = [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"},
    ]
    sparse = {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}
    named = {"attributes": {"POSITION": 0, "NORMAL": 0, "COLOR_0": 0}}
    instanced = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}
    inline = "data:;base64," + base64.b64encode(POSITIONS + INDICES).decode()
    return [
        document(),
        document(nodes=[{"children": [1], "rotation": [0, 0, 0.7, 0.7]}, {"mesh": 0, "scale": [1, 2, -3]}]),
        document(nodes=[{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 9, 9, 1]}]),
        document(nodes=[{"mesh": 0, "extensions": instanced}]),
        document(named),
        document({"mode": 5}),
        document({"mode": 0}),
        document(extensions={"CESIUM_RTC": {"center": [1, 2, 3]}}, extensionsRequired=["CESIUM_RTC"]),
        document({}, SQUEEZED + SQUEEZED_INDICES, views, accessors=four),
        document(
            accessors=[
                {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse},
                {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"},
            ]
        ),
        document(buffers=[{"byteLength": 60, "uri": inline}]),
        document(
            buffers=[{"byteLength": 36, "uri": "a.bin"}], bufferViews=[{"buffer": 0, "byteLength": 36}] * 2
        ),
        *(textured(picture) for picture in (PNG, JPEG, WEBP)),
    ]


def points():
    """A feature table, a newline and its binary part."""
    quantized = {
        "POINTS_LENGTH": 3,
        "POSITION_QUANTIZED": {"byteOffset": 0},
        "QUANTIZED_VOLUME_OFFSET": [0, 0, 0],
        "QUANTIZED_VOLUME_SCALE": [9, 9, 9],
        "NORMAL_OCT16P": {"byteOffset": 0},
    }
    tables = [
        TABLE_3,
        {**TABLE_3, "RGB": {"byteOffset": 0}, "NORMAL": {"byteOffset": 0}},
        quantized,
        {**TABLE_3, "RGB565": [1, 2, 3]},
        {**TABLE_3, "CONSTANT_RGBA": [1, 2, 3, 4], "RGBA": {"byteOffset": 4}},
    ]
    return [compact(table) + b"\n" + POSITIONS for table in tables]


def instances():
    """A feature table, a newline, its binary part, a newline, then a document or a uri."""
    two = {"INSTANCES_LENGTH": 2, "POSITION": {"byteOffset": 0}, "RTC_CENTER": [6378137, 0, 0]}
    table = compact(
        {**two, "NORMAL_UP": {"byteOffset": 0}, "NORMAL_RIGHT": {"byteOffset": 12}, "SCALE": [1, 2]}
    )
    upright = compact({**two, "EAST_NORTH_UP": True, "SCALE_NON_UNIFORM": [1, 2, 3, 4, 5, 6]})
    embedded = [
        b"\x01" + t + b"\n" + POSITIONS + b"\n" + d for t in (table, upright) for d in documents()[:4]
    ]
    return [*embedded, b"\x02" + table + b"\n" + POSITIONS + b"\na.gltf"]


def whole(magic, table, body):
    head = struct.pack("<4sIIIIII", magic, 1, 28 + len(table) + len(body), len(table), 0, 0, 0)
    return head + table + body


def seeds():
    """Seeds by reader."""
    table = b'{"BATCH_LENGTH":0,"RTC_CENTER":[1,2,3]}\n\n'
    b3dm = [bytes([form]) + table + d for form in (1, 2, 3) for d in documents()[:3]] + [
        b"\x01" + table + d for d in documents()[3:]
    ]
    gltf = [b"\x01" + d for d in documents()] + [b"\x00" + documents()[-4].partition(b"\n")[0]]
    pnts = [b"\x01" + p for p in points()]
    raw = whole(b"pnts", compact({"POINTS_LENGTH": 1, "POSITION": [1, 2, 3]}), b"")
    cmpt = [b"\x01" + p + b"\n" + d for p in points()[3:] for d in documents()[:2]]
    cmpt += [bytes([form]) + raw for form in (2, 5, 26, 29)]
    return {"b3dm": b3dm, "i3dm": instances(), "cmpt": cmpt, "pnts": [*pnts, b"\x00" + raw], "gltf": gltf}
