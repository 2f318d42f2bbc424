"""glTF scene and viewer page of a small shot: read again, positions agree in Earth-centred metres."""

import base64
import gzip
import hashlib
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_gltf
from firetwin.export import fronts, gltf, gltf_forest, gltf_terrain, viewer_page
from firetwin.export.viewer_page import PageText
from page_parts import PageParts
from PIL import Image
from pyproj import Transformer
from small_gltf import HOSTILE, IDS, TREES

THREE = Path(viewer_page.__file__).parent / "viewer/three"
TYPES = {5126: "<f4", 5123: "<u2", 5125: "<u4", 5122: "<i2"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    """A .glb read by the format's specification alone."""

    def __init__(self, data):
        _magic, version, length = np.frombuffer(data, "<u4", 3)
        assert (bytes(data[:4]), version, length) == (b"glTF", 2, len(data))
        size = int(np.frombuffer(data, "<u4", 1, 12)[0])
        assert (data[16:20], size % 4) == (b"JSON", 0)
        self.json = json.loads(data[20 : 20 + size])
        assert data[24 + size : 28 + size] == b"BIN\0"
        self.buffer = data[28 + size :]
        assert len(self.buffer) == int(np.frombuffer(data, "<u4", 1, 20 + size)[0])
        self.about = self.json["scenes"][0]["extras"]["firetwin"]

    def view(self, number):
        found = self.json["bufferViews"][number]
        return self.buffer[found["byteOffset"] :][: found["byteLength"]]

    def values(self, number):
        each = self.json["accessors"][number]
        size, kind = SIZES[each["type"]], TYPES[each["componentType"]]
        assert self.json["bufferViews"][each["bufferView"]]["byteOffset"] % 4 == 0
        found = np.frombuffer(self.view(each["bufferView"]), kind).reshape(each["count"], size)
        if "min" in each:
            np.testing.assert_array_equal(each["min"], found.min(axis=0))
            np.testing.assert_array_equal(each["max"], found.max(axis=0))
        return found / np.iinfo(kind).max if each.get("normalized") else found.astype(np.float64)

    def nodes(self, parent):
        """Nodes below the node with this name."""
        nodes = self.json["nodes"]
        (holder,) = [node for node in nodes if node.get("name") == parent]
        return [nodes[k] for k in holder["children"]]

    def instances(self):
        """Instances by attribute, and their nodes' numbers of meshes, of all trees."""
        parts = [
            {
                key: self.values(k)
                for key, k in node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"].items()
            }
            | {"mesh": node["mesh"]}
            for node in self.nodes("trees")
        ]
        for part in parts:
            assert len({len(values) for key, values in part.items() if key != "mesh"}) == 1
        return parts

    def ecef(self, points):
        """Earth-centred metres of the file's points (n, 3)."""
        matrix = np.reshape(self.about["gltf_to_ecef"], (4, 4)).T
        return np.asarray(points) @ matrix[:3, :3].T + matrix[:3, 3]


def by_proj(shot, position):
    """Convert scene positions to Earth-centred metres by PROJ alone."""
    frame = shot.local_frame
    pipeline = (
        f"+proj=pipeline +step +inv +proj=topocentric +lat_0={frame.latitude!r} +lon_0={frame.longitude!r} "
        f"+h_0={frame.height - 24.9!r} +ellps=WGS84"
    )
    return np.transpose(Transformer.from_pipeline(pipeline).transform(*np.transpose(position)))


def matrix(quaternion):
    """Rotation matrix of a quaternion x, y, z, w."""
    x, y, z, w = quaternion / np.linalg.norm(quaternion)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Shot, content, request, .glb and page of a small run with hostile names."""
    *inputs, scene, page = small_gltf.write(tmp_path_factory.mktemp("gltf"))
    return *inputs, scene.read_bytes(), page.read_bytes()


@pytest.fixture(scope="module")
def read(small):
    return Glb(small[3])


def test_trees_are_where_proj_puts_them(small, read):
    shot, whole, *_ = small
    (trees,) = whole.plants
    parts = read.instances()
    number = np.concatenate([part["_ID"][:, 0] for part in parts])
    order = TREES - 1 - (number - IDS.min()).astype(int)
    assert sorted(order) == list(range(TREES))
    found = read.ecef(np.concatenate([part["TRANSLATION"] for part in parts]))
    assert np.abs(found - by_proj(shot, trees.position[order])).max() < 0.01
    arrival = np.concatenate([part["_ARRIVAL"][:, 0] for part in parts])
    start = float(shot.run.times[0])
    want = np.where(np.isfinite(trees.arrival), trees.arrival - start, 1e9)[order]
    np.testing.assert_allclose(arrival, want, rtol=1e-6)
    assert len(parts) > 20  # cells of 4 km, and two levels


def test_an_instance_has_the_shape_of_its_tree(small, read):
    _, whole, *_ = small
    (trees,) = whole.plants
    part = read.instances()[3]
    points = np.unique(
        np.concatenate(
            [
                read.values(each["attributes"]["POSITION"])
                for each in read.json["meshes"][part["mesh"]]["primitives"]
            ]
        ),
        axis=0,
    )
    for k in range(len(part["_ID"])):
        found = part["TRANSLATION"][k] + (part["SCALE"][k] * points) @ matrix(part["ROTATION"][k]).T
        tree = TREES - 1 - int(part["_ID"][k, 0] - IDS.min())
        own = whole.prototypes[trees.prototype[tree]].points * trees.scale[tree]
        turned = own @ matrix(np.roll(trees.rotation[tree], -1)).T
        want = (trees.position[tree] + turned)[:, [0, 2, 1]] * (1, 1, -1)
        apart = np.abs(found[:, None] - want[None]).max(axis=2)
        assert apart.min(axis=0).max() < 0.01
        assert apart.min(axis=1).max() < 0.01


def test_a_camera_is_where_proj_puts_it_and_looks_the_same_way(small, read):
    shot, *_ = small
    path, (clip,) = shot.paths[0], read.json["animations"]
    (node,) = read.nodes("cameras")
    assert node["name"] == clip["name"] == HOSTILE
    assert all(read.json["nodes"][each["target"]["node"]] == node for each in clip["channels"])
    place, turn = (read.values(each["output"]) for each in clip["samplers"])
    assert [each["target"]["path"] for each in clip["channels"]] == ["translation", "rotation"]
    np.testing.assert_allclose(
        read.values(clip["samplers"][0]["input"])[:, 0], np.arange(4) / 24.0, rtol=1e-6
    )
    here = by_proj(shot, path.position)
    assert np.abs(read.ecef(place) - here).max() < 0.01
    x, y, z, w = turn.T
    back = np.stack([2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)], axis=-1)
    up = np.stack([2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)], axis=-1)
    for found, axis in ((back, 2), (up, 1)):
        want = by_proj(shot, path.position + 100.0 * path.rotation[:, :, axis])
        assert np.abs(read.ecef(place + 100.0 * found) - want).max() < 0.02
    (lens,) = read.json["cameras"]
    assert np.tan(lens["perspective"]["yfov"] / 2) == pytest.approx(path.halves[0, 1], rel=1e-3)


def test_fronts_lie_on_the_ground_where_proj_puts_them(small, read):
    shot, _, request, *_ = small
    dated = fronts.find(request)
    nodes = read.nodes("fronts")
    assert [node["extras"]["area_m2"] for node in nodes] == [front.area for front in dated]
    front, node = dated[-1], nodes[-1]
    assert node["extras"]["time_utc"] == "2014-09-17T04:47:00Z"
    (part,) = read.json["meshes"][node["mesh"]]["primitives"]
    local, pairs = read.values(part["attributes"]["POSITION"]), read.values(part["indices"])
    points = read.ecef(local)
    to_ecef = Transformer.from_crs(4979, 4978)
    for line in front.lines:
        row, column = shot.ground.indices(line[:, 1], line[:, 0])
        height = shot.ground.height(row, column)
        want = np.transpose(to_ecef.transform(line[:, 1], line[:, 0], height - 24.9))
        assert np.linalg.norm(points[:, None] - want[None], axis=2).min(axis=0).max() < 0.01
    ends = pairs.reshape(-1, 2).astype(int)
    assert part["mode"] == 1
    assert np.hypot(*(local[ends[:, 0]] - local[ends[:, 1]])[:, [0, 2]].T).max() < 121.0
    assert len(ends) == len(points) - len(front.lines)


def test_the_ground_carries_its_arrival_times(small, read):
    shot, *_ = small
    (node,) = [each for each in read.json["nodes"] if each.get("name") == "terrain"]
    (part,) = read.json["meshes"][node["mesh"]]["primitives"]
    about = read.json["materials"][part["material"]]["extras"]["arrival"]
    image = read.json["images"][read.json["textures"][about["texture"]]["source"]]
    pixels = np.asarray(Image.open(io.BytesIO(read.view(image["bufferView"]))), np.int64)
    counts = (pixels[..., 0] * 256 + pixels[..., 1])[::-1]
    ground = shot.ground
    place = np.meshgrid(*(np.arange(n, dtype=float) for n in ground.shape), indexing="ij")
    want = ground.arrival_at(*place)
    shown = (want <= shot.run.times[-1]) & (want < 1e9)
    assert shown.any()
    np.testing.assert_array_equal(counts == about["never"], ~shown)
    want = np.maximum(want, shot.run.times[0]) - shot.run.times[0]
    assert np.abs(counts * about["step_s"] - want)[shown].max() <= 0.51 * about["step_s"]
    points, uv = (read.values(part["attributes"][key]) for key in ("POSITION", "TEXCOORD_0"))
    east = np.argmax(points[:, 0]), np.argmin(points[:, 0])
    south = np.argmax(points[:, 2]), np.argmin(points[:, 2])
    assert uv[east[0], 0] > uv[east[1], 0]
    assert uv[south[0], 1] > uv[south[1], 1]  # downwards in the picture
    faces = points[read.values(part["indices"]).astype(int).reshape(-1, 3)]
    assert np.all(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])[:, 1] > 0.0)


def test_the_file_keeps_to_the_format(read):
    assert read.json["extensionsUsed"] == ["EXT_mesh_gpu_instancing", "KHR_materials_unlit"]
    assert "extensionsRequired" not in read.json
    for k, each in enumerate(read.json["accessors"]):
        assert np.isfinite(read.values(k)).all()
        step = SIZES[each["type"]] * np.dtype(TYPES[each["componentType"]]).itemsize
        assert step % 4 == 0 or each["type"] == "SCALAR"
    for mesh in read.json["meshes"]:
        for part in mesh["primitives"]:
            count = read.json["accessors"][part["attributes"]["POSITION"]]["count"]
            assert read.values(part["indices"]).max() == count - 1
            for key in ("NORMAL",):
                if key in part["attributes"]:
                    length = np.linalg.norm(read.values(part["attributes"][key]), axis=1)
                    np.testing.assert_allclose(length, 1.0, atol=1e-5)
    seen = sorted(child for node in read.json["nodes"] for child in node.get("children", []))
    assert seen == list(range(1, len(read.json["nodes"])))  # one tree below node 0
    assert read.json["nodes"][0]["name"] == read.about["run"] == HOSTILE
    assert read.about["georeference"]["geoid_m"] == -24.9


def test_a_still_or_flat_camera_has_no_animation_and_its_own_lens(small):
    _, whole, request, *_ = small
    (move,) = whole.cameras
    still = replace(move, position=move.position[[0] * 4], rotation=move.rotation[[0] * 4])
    flat = replace(still, name="flat", projection="orthographic", half=np.full((4, 2), (200.0, 150.0)))
    focal = np.array([20.0, 30.0, 40.0, 50.0])
    zoomed = replace(still, name="zoom", half=np.array([18.0, 10.125]) / focal[:, None])
    found = Glb(gltf.encode(replace(whole, cameras=[flat, zoomed], plants=[]), request, []))
    assert "animations" not in found.json
    one, two = found.json["cameras"]
    assert (one["orthographic"]["xmag"], one["orthographic"]["ymag"]) == (200.0, 150.0)
    np.testing.assert_allclose(found.nodes("cameras")[1]["extras"]["yfov"][3], 2 * np.arctan(20.25 / 100.0))
    assert two["perspective"]["yfov"] == pytest.approx(2 * np.arctan(20.25 / 40.0))


def test_a_tree_of_many_needles_becomes_the_same_tree_in_the_next_level(small):
    _, whole, *_ = small
    near, far = whole.prototypes
    heavy = replace(near, name="large_00_living_level0", level=0, triangles=np.zeros((20_000, 3), np.int64))
    other = replace(heavy, name="oak_10_living_level0")
    assert gltf_forest.light_prototypes([heavy, far, near, other]).tolist() == [2, 1, 2, 3]


def test_arrival_times_before_and_after_the_span_are_clamped_or_never():
    times = np.array([[-5.0, 0.0, 50.0, 100.0], [101.0, 1e9, np.inf, 99.9]])
    data, step = gltf_terrain.encode_arrival(times, 0.0, 100.0)
    pixels = np.asarray(Image.open(io.BytesIO(data)), np.int64)
    counts = pixels[..., 0] * 256 + pixels[..., 1]
    assert counts[0].tolist() == [0, 0, 32767, 65534]
    assert counts[1, :3].tolist() == [65535] * 3
    assert counts[1, 3] * step == pytest.approx(99.9, abs=step)


def test_the_page_holds_the_scene_and_refers_to_nothing_else(small):
    *_, scene, page = small
    page = page.decode()
    held = re.search(r'<script type="text/plain" id="scene">([^<]*)</script>', page)[1]
    assert gzip.decompress(base64.b64decode(held, validate=True)) == scene
    parts = PageParts(page)
    scripts = [inside for each, inside in parts.all("script") if "type" not in each]
    (style,) = [inside for _, inside in parts.all("style")]
    policy = next(each["content"] for each, _ in parts.all("meta") if "http-equiv" in each)
    assert policy.startswith("default-src 'none'; ")
    hashes = [
        f"'sha256-{base64.b64encode(hashlib.sha256(each.encode()).digest()).decode()}'" for each in scripts
    ]
    assert f"script-src {' '.join(hashes)};" in policy
    assert base64.b64encode(hashlib.sha256(style.encode()).digest()).decode() in policy
    for tag, names in (("script", ["src"]), ("link", ["href"]), ("img", ["src"]), ("a", ["href"])):
        for each, _ in parts.all(tag):
            assert [each[k] for k in names if k in each] in (
                [],
                ["data:,"],
                ["#slider"],
                ["https://threejs.org"],
            )
    assert "url(" not in style


def test_hostile_names_are_text_on_the_page(small):
    parts = PageParts(small[4].decode())
    assert len(parts.all("script")) == 3
    assert not parts.all("img")
    (title,) = [inside for _, inside in parts.all("title")]
    assert title.startswith("</script><script>alert(1)</script>\"' <img src=x")
    assert "\u202e" not in parts.text
    assert "\\u202e" in parts.text
    assert "The MIT License" in parts.text
    assert "GPL-3.0-or-later" in parts.text


def test_the_page_says_that_a_run_is_synthetic_and_shows_credits():
    marks = [("SYNTHETIC", "This scene is synthetic, not the output of a fire model.")]
    made = PageParts(viewer_page.html(b"glTF", PageText("A", marks, [("Run", "A")], "© <b> Survey")))
    assert "This scene is synthetic" in made.text
    assert [inside for each, inside in made.all("p") if each.get("class") == "credit"] == ["© <b> Survey"]
    assert any(each.get("class") == "stamp" for each, _ in made.all("div"))
    plain = PageParts(viewer_page.html(b"glTF", PageText("A", [], [], "")))
    assert "synthetic" not in plain.text.lower()
    assert not [
        each for tag in ("p", "div") for each, _ in plain.all(tag) if each.get("class") in ("stamp", "credit")
    ]


def test_three_js_is_the_bundle_that_its_readme_describes():
    table = re.findall(r"\| `(\w[\w.]+)` \| `([0-9a-f]{64})` \|", (THREE / "README.md").read_text())
    assert [name for name, _ in table] == ["entry.js", "three.js", "LICENSE"]
    for name, digest in table:
        assert hashlib.sha256((THREE / name).read_bytes()).hexdigest() == digest
